. "$here/table.sh"
before() {
  link_configs
  cp building.toml b.toml
  echo a-token-of-its-own-1 >token
  ip address add 192.168.1.7/32 dev lo
}
expected='
^http://127.0.0.1:8080/\?token=[0-9a-f]+$
^http://192.168.1.7:8080/$
'
