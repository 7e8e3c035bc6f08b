. "$here/table.sh"
before() {
  link_configs
  shake 30 record.csv
}
expected='
^mode +identified
^ +1 +[0-9.]+ .*(x|y|rotation)$
identified from [0-9.]+ s
'
