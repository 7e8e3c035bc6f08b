before() {
  cp "$root/configs/table_two_story.toml" building.toml
}
