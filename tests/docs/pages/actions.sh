# A building of which three stiffnesses are a sixth below their baseline: events 1 to 3.
. "$here/table.sh"
before() {
  link_configs
  shake 60 record.csv
  framewatch replay building.toml record.csv --quiet --write-baseline learned.toml
  awk '/^name/ { raised = /kx_1_y1|kx_2_y2|ky_1_x2/ } raised && /^value = / { $3 *= 1.2 } { print }' learned.toml >baseline.toml
  printf '[watch]\nbaseline = "baseline.toml"\n' >>building.toml
  framewatch run building.toml &
  shake_live 120
  sleep 15
  framewatch status building.toml || true
}
expected='
^stiffness_change k.* \(3\) is acknowledged by 
^stiffness_change k.* \(1\) is acknowledged by .* \(says: night shift, Jo\)
'
