. "$here/table.sh"
before() {
  link_configs
  shake 20 record.csv
  framewatch convert record.csv --config building.toml --start-us 1795280400000000 monday.lcmlog
  framewatch convert record.csv --config building.toml --start-us 1795366800000000 tuesday.lcmlog
  zstd -q tuesday.lcmlog
  cp monday.lcmlog golden.lcmlog
  framewatch replay building.toml golden.lcmlog --quiet --write-expect expected.toml
  sed -i 's/^reason = ""/reason = "as the scenario says"/' expected.toml
}
expected='
windows 3970
"schema": "framewatch.replay/1"
windows 1986
as expected
'
