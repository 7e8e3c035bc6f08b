expected='
Open http://127.0.0.1:8080/
At 20 s frame y2 of story 1 loses 15 %
^demo.html
HOLDS: frame stiffness within 0.0
At 20 s frame y2 of stories 6 to 10 loses 20 %
HOLDS: frame stiffness within
'
