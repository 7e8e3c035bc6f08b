. "$here/table.sh"
before() {
  link_configs
  shake 20 record.csv
  framewatch replay building.toml record.csv --out yesterday.lcmlog
  cp yesterday.lcmlog today.lcmlog
}
expected='
files: identical, byte by byte
'
