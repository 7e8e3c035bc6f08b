# Three floors that move along x, in m/s^2; nobody is there to be asked.
before() {
  awk 'BEGIN { print "time_s,acc0,F1-X,F2-X,F3-X"; for (i = 0; i < 500; ++i) printf "%.2f,%.6f,%.6f,%.6f,%.6f\n", 0.01 * i, sin(0.2 * i), sin(0.3 * i), sin(0.4 * i), sin(0.5 * i) }' >shaken.csv
}
expected='
building.toml
tower.toml
'
