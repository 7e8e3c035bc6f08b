# No daemon runs that could keep the note.
before() { cp "$root/configs/table_two_story.toml" building.toml; }
expected='
^framewatch note: 
'
