expected='
^paper/report.html; 20 of 20 promises kept
'
