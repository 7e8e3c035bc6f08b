. "$here/first-building.sh"
expected='
commands.md:
^parameter +q1 +median
kx_1_y1 +90[0-9][0-9]
'
