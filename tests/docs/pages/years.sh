# A minute of 2026-11-21 and its weather.
before() {
  ln -s "$root/configs/table_two_story.toml" table.toml
  cp table.toml building.toml
  ln -s "$root/configs" configs
  printf '[history]\ndirectory = "history"\n' >>building.toml
  framewatch simulate "$root/configs/scenario_table_two_story.toml" --seconds 60 --out rec.csv --quiet
  framewatch convert rec.csv --config building.toml --start-us 1795280400000000 rec.lcmlog
  mkdir -p history/raw
  zstd -q rec.lcmlog -o history/raw/20261121T120000Z.lcmlog.zst
  framewatch replay building.toml rec.lcmlog --out history/history.sqlite
  printf 'time,outside_degc,humidity_pct\n2026-11-21T12:00Z,4.5,81\n' >weather.csv
}
expected='
^1 day with values, 2026-11-21 to 2026-11-21; weather: not known, the season stands for it
^no loss of at least 1 % that weather does not explain
^kx_1_y1 .* no loss
^all alike .* no loss
^1 day with values, 2026-11-21 to 2026-11-21; weather: outside_degc, humidity_pct
^no loss of at least 1 % that weather does not explain
^1 day with values, 2026-11-21 to 2026-11-21; weather: not known, the season stands for it
^1 loss of at least 1 %
kx_2_y1 -[34]\.[0-9] ± 0\.[0-9] %, since 2026-03-
'
