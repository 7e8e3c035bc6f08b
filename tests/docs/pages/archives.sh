# A minute of the evening of 2026-11-21, kept on disk.
before() {
  framewatch fleet help >/dev/null || lacks "no framewatch-fleet (deploy/install-deps --with fleet)"
  cp "$root/configs/table_two_story.toml" building.toml
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
^\{"schema":"framewatch.reid/1","task":1,.*"result":"done"
^20261121T000000Z.json
^20261121T000000Z.sqlite
^kx_1_y1 +3[34][0-9]+
'
