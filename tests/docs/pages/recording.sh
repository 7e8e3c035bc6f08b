before() {
  ln -s "$root/configs/table_two_story.toml" table.toml
  framewatch simulate "$root/configs/scenario_table_two_story.toml" --lcm --seconds 200 --quiet &
  sleep 1
}
