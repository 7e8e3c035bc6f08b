# A base and three floors along x and y, in m/s^2; nobody is there to be asked.
before() {
  awk 'BEGIN {
    print "time_s,acc0,base-y,F1-X,F1-Y,F2-X,F2-Y,F3-X,F3-Y"
    for (i = 0; i < 500; ++i) {
      printf "%.2f", 0.01 * i
      for (k = 2; k < 10; ++k) printf ",%.6f", sin(0.1 * k * i)
      print ""
    }
  }' >shaken.csv
}
expected='
twelve.toml
building.toml
tower.toml
'
