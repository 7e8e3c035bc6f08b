# A building on a shaking table: half a minute as a file, and live.
before() {
  PATH=/usr/bin:$PATH
  python3 -c 'import numpy' 2>/dev/null || { echo "no python3-numpy (deploy/install-deps --with docs)"; exit 77; }
  ln -s "$root/lcmtypes" .
  cp "$root/configs/table_two_story.toml" building.toml
  framewatch simulate "$root/configs/scenario_table_two_story.toml" --seconds 30 --out record.csv --quiet
  framewatch simulate "$root/configs/scenario_table_two_story.toml" --lcm --seconds 250 --quiet &
}
expected='
kx_1_y1 is 3[34][0-9][0-9][0-9] \+- [0-9.]+ N/m in [0-9]+ of [0-9]+ windows
^kx_1_y1 +3[34]
s: kx_1_y1 is 3[34][0-9][0-9][0-9] \+- [0-9.]+ N/m
s: kx_1_y1 is 3[34]
s: kx_1_y1 is 3[34]
'
