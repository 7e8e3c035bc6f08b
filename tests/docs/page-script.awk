# page-script.awk: what is to be done with a page's blocks of commands.
#   -v stem=S: S.sh its commands as a script, S.count a line for each: "run", or why not; S.wrong: lines of
#   commands in blocks that nothing runs.
#   S.as: the page that has a command too, a tab, the command.
#   -v tested=T: which languages' blocks another test runs (a regular expression), of this page.
function option(name) {
  return match(info, " " name "=[^ ]+") ? substr(info, RSTART + length(name) + 2, RLENGTH - length(name) - 2) : ""
}
function command() { return /^ *(\$ )?(framewatch|\.\/[a-z]|deploy\/|tests\/|curl|sudo|apt|systemctl|lcm-|\$study|cmake|cd|cp|ssh|source) ?/ }
function wrong(why) { printf "%s:%d: %s\n", page, FNR, why >(stem ".wrong") }
FNR == 1 { page = page == "" ? FILENAME : page }
/^ *```/ && !inside {
  inside = 1
  info = $0
  sub(/^ *```/, "", info)
  language = info
  sub(/ .*/, "", language)
  file = option("file")
  needs = option("needs")
  as = option("as")
  if (as != "") needs = "stands in " as " too"
  run = language == "sh" && needs == ""
  if (file != "") print "cat >" file " <<\047END OF FILE\047" >(stem ".sh")
  if (run) printf "echo \047== %s:%d\047\n", page, FNR + 1 >(stem ".sh")
  next
}
/^ *```/ {
  inside = 0
  if (file != "") print "END OF FILE" >(stem ".sh")
  if (run && option("seconds") != "")
    last = "interrupted " option("seconds") " " last
  if (run && option("status") != "")
    last = "s=0; " last " || s=$?; [[ ," option("status") ", = *,$s,* ]]"
  if (run && info ~ / background( |$)/) last = last " &\nsleep 2"
  if (run) print last >(stem ".sh")
  if (run && option("pause") != "") print "sleep " option("pause") >(stem ".sh")
  last = ""
  next
}
inside && as != "" { print as "\t" $0 >(stem ".as") }
inside && language == "sh" && !/^ *(#|$)/ {
  if (!continued) print (run ? "run" : needs) >(stem ".count")
  continued = /\\$/
}
inside && file != "" { print >(stem ".sh") }
inside && run {
  if (last != "") print last >(stem ".sh")
  last = $0
  next
}
inside && language !~ /^(sh|toml|json|sql)$/ && (tested == "" || language !~ tested) && command() {
  wrong("a command in a block that is not ```sh")
}
!inside && /^(    |\t)/ && command() { wrong("a command that is indented: put it into a block ```sh") }
