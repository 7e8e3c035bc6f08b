before() {
  cp "$root/configs/table_two_story.toml" building.toml
}
expected='
^opensees/model\.tcl, opensees/model\.py: written
^matrices: M, C and K of 8 rows written
'
