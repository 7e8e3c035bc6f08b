. "$here/table.sh"
before() {
  link_configs
  shake 30 run1.csv
  cp run1.csv run2.csv
  framewatch replay table.toml run1.csv --out monday.lcmlog
  cp monday.lcmlog friday.lcmlog
}
expected='
^run2.csv does not differ from run1.csv: 
'
