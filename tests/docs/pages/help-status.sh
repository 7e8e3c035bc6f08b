. "$here/table.sh"
before() {
  link_configs
  framewatch run building.toml --quiet &
  shake_live 60
  sleep 14
}
expected='
two-story table model: (not )?well
10 channels, 1000 a second; 0 lost
20 of 20 values now
'
