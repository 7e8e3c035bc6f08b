# Records as their recorders write them: a spreadsheet in g and ms, PEER's two columns, plain numbers, and one
# file for each floor of a shaking table.
. "$here/table.sh"
before() {
  link_configs
  shake 20 rec.csv
  awk 'BEGIN { print "Time;roof"; for (i = 0; i < 500; ++i) printf "%d;%.6f\n", 10 * i, 0.01 * sin(0.3 * i) }' >sheet.csv
  awk 'BEGIN { for (i = 0; i < 500; ++i) printf "%.3f %.6f\n", 0.02 * i, 0.1 * sin(0.2 * i) }' >elcentro_NS.dat
  awk 'BEGIN { for (i = 0; i < 500; ++i) printf "%.3f\n", 100 * sin(0.2 * i) }' >hachi.txt
  for floor in ground first second top; do
    awk -v floor=$floor 'BEGIN { print "time_s," floor; for (i = 0; i < 500; ++i) printf "%.2f,%.6f\n", 0.01 * i, sin(0.2 * i) }' |
      gzip >$floor.csv.gz
  done
  framewatch replay building.toml rec.csv --out est.lcmlog
}
expected='
the main window.s estimates, of FRAMEWATCH_ESTIMATE
'
