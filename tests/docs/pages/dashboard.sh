before() { ln -s "$root/configs/table_two_story.toml" building.toml; }
expected='
^http://127.0.0.1:8080/
: stopped: 
'
