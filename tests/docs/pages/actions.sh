# A building whose nodes fell silent: events to know of.
before() {
  ln -s "$root/configs/table_two_story.toml" building.toml
  framewatch run building.toml --quiet &
  sleep 1
  framewatch simulate "$root/configs/scenario_table_two_story.toml" --lcm --seconds 3 --quiet
  for _ in $(seq 60); do
    framewatch status building.toml >status.txt || true
    if grep -q '^  event *3 ' status.txt; then break; fi
    sleep 1
  done
  cat status.txt
}
