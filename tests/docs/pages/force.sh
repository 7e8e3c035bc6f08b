# A frame on a base that rests, driven by a measured force; and a spring that hardens, on a test bench: a mass of 2 kg,
# 8 N/m + 60 N/m^3, pushed by a sum of sines and sampled 50 times a second.
before() {
  cat >spring.toml <<'END'
[structure]
name = "a spring"
stories = 1
frames_x = ["y1"]
story_height_m = [1.0]
node_mass_kg = 2.0

[structure.design]
kx_npm = [[8.0]]
damping_ratio = 0.02

[estimator]
rate_hz = 50

[[channel]]
name = "base"
story = 0
direction = "x"

[[channel]]
name = "y"
story = 1
frame = "y1"
END
  push 1 >a.csv
  push 2 >b.csv
}
push() { # push SEED
  awk -v seed="$1" 'BEGIN {
    srand(seed)
    for (i = 0; i < 40; ++i) { w[i] = 0.3 + 0.15 * i; phase[i] = 6.2831853 * rand() }
    print "time_s,y,u"
    for (step = 0; step < 120 * 5000; ++step) {
      t = step / 5000; u = 0
      if (step % 10 == 0) { for (i = 0; i < 40; ++i) u += 0.05 * sin(w[i] * t + phase[i]); held = u }
      if (step % 100 == 0) printf "%.2f,%.9f,%.9f\n", t, y + 3e-3 * (rand() - 0.5), held
      v += (held - 0.3 * v - 8 * y - 60 * y * y * y) / 2 / 5000
      y += v / 5000
    }
  }'
}
expected='
the base is taken to rest
kx_2
kx_3
converged
Nothing is missing
cubic stiffness at story 1, frame y1
'
