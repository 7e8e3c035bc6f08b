. "$here/table.sh"
before() { link_configs; shake 30 record.lcmlog; }
expected='
converged
kx_1_y1 +3[34][0-9.]+ +3[34]
'
