. "$here/table.sh"
before() { link_configs; }
expected='
6001 instants at 100 Hz to rec.lcmlog
22 channels, 4001 instants
11667 hours to years
'
