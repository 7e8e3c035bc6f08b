. "$here/table.sh"
before() { link_configs; shake_live 60; }
expected='
stopped: [0-9]+ windows, 0 interruptions, 0 messages lost
'
