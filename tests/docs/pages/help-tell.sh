. "$here/table.sh"
before() {
  link_configs
  printf '[actions]\ncommand = ["/usr/bin/tee", "told.json"]\n' >>building.toml
}
expected='
command +delivered
'
