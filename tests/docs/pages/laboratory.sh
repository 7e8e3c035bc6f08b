. "$here/table.sh"
# A logger's file: German titles, time stamps, decimal commas, g.
log_as() { # log_as RECORD OUT
  LC_ALL=C awk -F, '
    NR == 1 {
      printf "Zeit;Fundament X [g];Fundament Y [g]"
      for (floor = 1; floor <= 2; ++floor)
        printf ";%d. OG y1 [g];%d. OG y2 [g];%d. OG x1 [g];%d. OG x2 [g]", floor, floor, floor, floor
      print ""
      next
    }
    {
      line = sprintf("2026-11-21 14:%02d:%06.3f", 3 + $1 / 60, $1 % 60)
      for (i = 2; i <= NF; ++i) line = line sprintf(";%.7f", $i / 9.80665)
      gsub(/\./, ",", line)
      print line
    }' "$1" >"$2"
}
before() {
  command -v chromium || lacks "chromium"
  link_configs
  rm building.toml
  shake 40 record.csv
  log_as record.csv logger.csv
  cp logger.csv logger2.csv
}
# Users do not run it as root, tests may.
chromium() {
  command chromium --no-sandbox "$@"
  grep -q 'Modes</h2>' report.html && ls figures/mode-1.csv figures/mode-8-2col.pdf report.pdf
}
expected='
^building.toml: written
^kx_1_y1 +3[0-9]+
^figures/mode-1.csv
^figures/mode-8-2col.pdf
^report.pdf
^logger2.csv does not differ from logger.csv: 
'
