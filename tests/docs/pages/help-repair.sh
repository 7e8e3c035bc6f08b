. "$here/table.sh"
before() {
  link_configs
  shake 20 night.lcmlog
  truncate --size=-1000 night.lcmlog
}
expected='
20 damaged bytes in 1 places; the intact events are in night.repaired.lcmlog
"damaged_bytes": 20
'
