expected='
identifiable groups of stories between the measured floors 3, 6 of 6
advice +with channels on floor
kx_1to3
converged
kx_4to6
Nothing is missing
'
