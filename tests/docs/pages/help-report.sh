. "$here/table.sh"
before() {
  link_configs
  shake 20 raw.lcmlog
  framewatch replay table.toml raw.lcmlog --out est.lcmlog
}
expected='
^r.html
'
