# A frame on a base that rests, driven by a measured force.
expected='
the base is taken to rest
kx_2
kx_3
converged
Nothing is missing
'
