# From ctest's JUnit file: one line per suite, "<preset>/<suite> passed failed skipped seconds", where
# a test's suite is its name up to the first dot. Reasons for skipping are appended to `skips`.
# Variables: preset, skips.
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
  suite = attribute("name")
  sub(/\..*/, "", suite)
  status = attribute("status")
  if (!(suite in total)) order[++suites] = suite
  ++total[suite]
  seconds[suite] += attribute("time")
  skipped_here = status == "disabled"
  reason = skipped_here ? "disabled" : ""
  take_next = 0
  if (status == "run") ++passed[suite]
  next
}
/^[ \t]*<skipped message="SKIP_/ { skipped_here = 1; next }
/^[ \t]*<\/testcase>/ {
  if (skipped_here) {
    ++skipped[suite]
    print plain(reason == "" ? last : reason) >> skips
  }
  last = ""
  next
}
skipped_here {
  line = $0
  sub(/^[ \t]*<system-out>/, "", line)
  sub(/<\/system-out>.*/, "", line)
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
