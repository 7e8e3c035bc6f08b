expected='
building.toml: good
kx_1_y1 +90[0-9][0-9]
kx_2_y1 +(79|80)[0-9][0-9]
kx_3_y1 +(69|70)[0-9][0-9]
'
