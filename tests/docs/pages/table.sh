# The demo building and what it is shaken by, for pages that begin with records or a running daemon.
link_configs() { # as building.toml and table.toml too
  ln -s "$root/configs" .
  cp configs/table_two_story.toml building.toml
  cp building.toml table.toml
}
shake() { # shake SECONDS OUT
  framewatch simulate configs/scenario_table_two_story.toml --seconds "$1" --out "$2" --quiet
}
shake_live() { # shake_live SECONDS [SPEED]
  framewatch simulate configs/scenario_table_two_story.toml --lcm --seconds "$1" --speed "${2:-1}" --quiet &
}
