. "$here/table.sh"
before() {
  link_configs
  shake_live 600
  sleep 1
}
expected='
recording sessions/.*_El-Centro-30 for 20 s
^sessions/.*_El-Centro-30/report.html
triggered by base-[xy]
^sessions/.*_sweep/report.html
: start, by
^sessions/.*_sweep/report.html
'
