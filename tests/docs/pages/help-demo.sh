expected='
Open http://127.0.0.1:8080/
At 20 s the frame of kx_1_y2 loses 15 %
^demo.html
HOLDS: frame stiffness within 0.0
'
