. "$here/table.sh"
before() { link_configs; }
expected='
configs/table_two_story.toml: good
identifiable stiffness and damping of all 8 frame stories
'
