. "$here/table.sh"
before() {
  link_configs
  shake 45 record.lcmlog
  shake 30 record.csv
}
expected='
^mode +identified
identified from [0-9.]+ s
identified from [0-9.]+ s
'
