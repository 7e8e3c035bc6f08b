# Two days of a building whose first story hardens.
before() {
  ln -s "$root"/configs/*.toml .
  cp "$root/configs/table_two_story.toml" building.toml
  sed 's/^seed = .*/seed = 72/' "$root/configs/scenario_cubic_first_story.toml" >tuesday.toml
  framewatch simulate scenario_cubic_first_story.toml --out monday.csv --quiet
  framewatch simulate tuesday.toml --out tuesday.csv --quiet
}
expected='
cubic stiffness at story 1, frame y1
'
