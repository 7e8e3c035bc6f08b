# The Northridge run, where the real records are.
before() {
  ln -s "$root/configs" .
  local data=${FRAMEWATCH_DATA:-$root/../shared/data}/mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story
  [ -d "$data" ] || exit 77
  for floor in Ground_Floor 1st_Floor 2nd_Floor 3rd_Floor_top; do
    mkdir "$floor"
    ln -s "$data/$floor/(Northridge)"*.csv.gz "$floor/RUN.csv.gz"
  done
}
expected='
kx_1
'
