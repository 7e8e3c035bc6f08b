# Summarizes ctest's JUnit file: one line per suite, "<preset>/<suite> passed failed skipped seconds". A test's suite
# is its name up to the first dot. Appends reasons for skipping to `skips`. Appends each failure to `failures`, with
# twelve lines of its output, from its first failed check or the last ones. Variables: preset, skips, failures.
function attribute(name,    text) {
  text = $0
  if (!sub(".*[ \t]" name "=\"", "", text)) return ""
  sub("\".*", "", text)
  return text
}
function plain(text) {
  gsub(/&lt;/, "<", text)
  gsub(/&gt;/, ">", text)
  gsub(/&quot;/, "\"", text)
  gsub(/&amp;/, "\\&", text)
  return text
}
/^[ \t]*<testcase / {
  name = suite = attribute("name")
  sub(/\..*/, "", suite)
  status = attribute("status")
  if (!(suite in total)) order[++suites] = suite
  ++total[suite]
  seconds[suite] += attribute("time")
  skipped_here = status == "disabled"
  reason = skipped_here ? "disabled" : ""
  take_next = 0
  if (status == "run") ++passed[suite]
  said = failed_here = 0
  next
}
/^[ \t]*<skipped message="SKIP_/ { skipped_here = 1; next }
/^[ \t]*<\/testcase>/ {
  if (skipped_here) {
    ++skipped[suite]
    print plain(reason == "" ? last : reason) >> skips
  } else if (status != "run") {
    print preset "/" name >> failures
    for (i = said > 12 ? said - 11 : 1; i <= said; ++i) print "    " plain(output[i % 12]) >> failures
  }
  last = ""
  next
}
status == "run" || /^[ \t]*<(failure|skipped)/ { next }
{
  line = $0
  sub(/^[ \t]*<system-out>/, "", line)
  sub(/<\/system-out>.*/, "", line)
  if (line ~ /: Failure$/ && !failed_here) {
    failed_here = 1
    said = 0
  }
  if (line != "" && !(failed_here && said == 12)) output[++said % 12] = line
}
skipped_here {
  if (take_next && reason == "") reason = line
  take_next = line ~ /: Skipped$/
  if (line != "") last = line
}
END {
  for (i = 1; i <= suites; ++i) {
    s = order[i]
    printf "%s/%s %d %d %d %.1f\n", preset, s, passed[s], total[s] - passed[s] - skipped[s],
      skipped[s], seconds[s]
  }
}
