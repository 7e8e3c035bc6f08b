before() {
  ln -s "$root/configs/table_two_story.toml" table.toml
  framewatch simulate "$root/configs/scenario_table_two_story.toml" --lcm --seconds 200 --quiet &
  sleep 1
}
expected='
recording sessions/.*_El-Centro-30 for 30 s
^sessions/.*_El-Centro-30/report.html
^http://127.0.0.1:8080/
'
