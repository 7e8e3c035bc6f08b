# The files of README.md's example.
before() {
  for file in building.toml shaken.toml; do
    awk -v begin="\`\`\`toml file=$file" '$0 == begin { inside = 1; next } /^```/ { inside = 0 } inside' "$root/README.md" >"$file"
  done
}
expected='
mine.toml: written
mine.toml: good
kx_1_y1 +90[0-9][0-9]
kx_3_y1 +(69|70)[0-9][0-9]
first-building.md:
kx_1_y1 +90[0-9][0-9]
'
