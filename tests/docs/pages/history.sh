# A minute of the evening of 2026-11-21, kept on disk.
before() {
  ln -s "$root/configs/table_two_story.toml" table.toml
  cp table.toml building.toml
  printf '[history]\ndirectory = "history"\n' >>building.toml
  framewatch simulate "$root/configs/scenario_table_two_story.toml" --seconds 60 --out rec.csv --quiet
  framewatch convert rec.csv --config building.toml --start-us 1795280400000000 rec.lcmlog
  framewatch run building.toml --quiet &
  await_run
  lcm-logplayer --speed=1.5 rec.lcmlog >/dev/null
  kill -INT $!
  wait
}
expected='
^2026-11-21T17:00:00Z  kx_1_y1 +3[34][0-9]+
^quake.lcmlog: [56][0-9]+ samples of 10 channels
^kx_1_y1 +3[34][0-9]+
'
