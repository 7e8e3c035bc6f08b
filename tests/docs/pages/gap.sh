# A plane frame whose first story hardens, watched under a model that was learned of it: the gap that is left is an
# event, with the id of the page, and its samples are stored.
before() {
  cat >building.toml <<'END'
[structure]
name = "plane frame"
stories = 2
frames_x = ["y1"]
story_height_m = 3.0
node_mass_kg = 40.0

[gap]
model = "adopted.toml"
store = "segments"
learn_s = 20
store_before_s = 40
store_after_s = 40
END
  channel base 0 'story = 0
direction = "x"'
  channel floor1 1 'story = 1
frame = "y1"'
  channel floor2 2 'story = 2
frame = "y1"'
  cat >scenario.toml <<'END'
config = "building.toml"
duration_s = 150.0
seed = 11

[truth]
kx_npm = [[28e3], [26e3]]
damping_ratio = 0.02

[motion]
peak_mps2 = 2.0
ground_frequency_hz = 3.0
ground_damping_ratio = 0.6
strong_s = 300.0
length_s = 400.0

[sensors]
noise_mps2_per_rthz = 1e-3

[[effect]]
kind = "cubic_stiffness"
story = 1
frame = "y1"
k3_npm3 = 2e7
END
  framewatch simulate scenario.toml --out record.csv --quiet
  framewatch convert record.csv --config building.toml --start-us 1795292200000000 record.lcmlog
  framewatch run building.toml &
  await_run
  lcm-logplayer --speed=2 record.lcmlog >/dev/null
  for _ in {1..60}; do ls segments/*.lcmlog && return; sleep 1; done
  return 1
}
channel() { # channel NAME NODE PLACE
  cat >>building.toml <<END

[[channel]]
name = "$1"
$3
source = { lcm = "ACCEL", node = $2, axis = "x" }
noise_mps2_per_rthz = 1e-3
END
}
expected='
The model lacks cubic stiffness at story 1, frame y1
adopted.toml is now d/model.toml
'
