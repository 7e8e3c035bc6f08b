# Writes the header `out` with the layout of every message of the .lcm files that are its input: a table
# that tells drivers/lcm/message_check how many bytes a payload must have. A file that is no message as we
# write them is reported as FILE:LINE: RULE; the exit status is then 1 and nothing is written.
#
#   awk -f lcm-layouts.awk -v out=message_layouts.hpp lcmtypes/*.lcm
#
# A message: package framewatch, one struct named as the file, fields of LCM's own types, arrays of one
# dimension whose length is a number or an int32_t field before them; and one comment line
# "// LCM channel: NAME", where * stands for any text: NAME*, *NAME.

BEGIN {
  bytes["int8_t"] = bytes["byte"] = bytes["boolean"] = 1
  bytes["int16_t"] = 2
  bytes["int32_t"] = bytes["float"] = 4
  bytes["int64_t"] = bytes["double"] = 8
  bytes["string"] = 0
}

FNR == 1 { end_of_file(); begin_file() }
{ read[FILENAME] = 1 }

{
  if (!in_comment && match($0, /^[ \t]*\/\/ LCM channel: /)) {
    if (channel != "") fail(FNR, "a second \"LCM channel\"")
    channel = substr($0, RSTART + RLENGTH)
    sub(/[^A-Z0-9_*].*/, "", channel)
    if (channel !~ /^(\*[A-Z0-9_]+|[A-Z0-9_]+\*?)$/)
      fail(FNR, "an LCM channel is capitals, digits and _, with one * before or after them")
  }
  split_line($0)
}

END {
  end_of_file()
  for (i = 1; i < ARGC; ++i)
    if (!(ARGV[i] in read)) {
      file = ARGV[i]
      fail(1, "an empty file")
    }
  if (failed) exit 1
  write_header()
}

function fail(line, rule) {
  printf "%s:%d: %s\n", file, line, rule > "/dev/stderr"
  failed = 1
  broken = 1
}

function begin_file() {
  file = FILENAME
  message = file
  sub(/.*\//, "", message)
  sub(/\.lcm$/, "", message)
  channel = ""
  broken = in_comment = tokens = 0
}

# Appends the line's words and symbols, without comments, to token[1..tokens].
function split_line(text) {
  while (text != "") {
    if (in_comment) {
      if (!match(text, /\*\//)) return
      in_comment = 0
    } else if (match(text, /^[ \t\r]+/)) {
    } else if (text ~ /^\/\//) {
      return
    } else if (match(text, /^\/\*/)) {
      in_comment = 1
    } else if (match(text, /^[A-Za-z_][A-Za-z0-9_.]*/) || match(text, /^[0-9]+/) || match(text, /^./)) {
      token[++tokens] = substr(text, 1, RLENGTH)
      line_of[tokens] = FNR
    }
    text = substr(text, RSTART + RLENGTH)
  }
}

function here() { return next_token <= tokens ? line_of[next_token] : last_line }
function word() { return next_token <= tokens ? token[next_token] : "the end of the file" }

function take(wanted) {
  if (broken) return
  if (word() != wanted) fail(here(), "expected \"" wanted "\", found \"" word() "\"")
  ++next_token
}

function take_name(what,    name) {
  if (broken) return ""
  name = word()
  if (name !~ /^[A-Za-z_][A-Za-z0-9_]*$/) fail(here(), "expected " what ", found \"" name "\"")
  ++next_token
  return name
}

function end_of_file() {
  if (file == "") return
  last_line = tokens > 0 ? line_of[tokens] : 1
  next_token = 1
  if (in_comment && !broken) fail(last_line, "a comment that does not end")
  take("package")
  take("framewatch")
  take(";")
  take("struct")
  if (!broken && word() != message)
    fail(here(), "the struct is named \"" word() "\", its file " message ".lcm")
  ++next_token
  take("{")
  fields = 0
  split("", field_at)  # by name, of this message
  while (!broken && word() != "}" && next_token <= tokens) read_fields()
  take("}")
  if (!broken && word() == ";") ++next_token
  if (!broken && next_token <= tokens) fail(here(), "a file holds one message: \"" word() "\" follows its end")
  if (!broken && fields == 0) fail(last_line, "a message without a field")
  if (!broken && channel == "") fail(1, "no comment line \"// LCM channel: NAME\"")
  if (broken) return
  message_name[++messages] = message
  message_channel[messages] = channel
  message_fields[messages] = fields
}

# A type and the fields declared with it, separated by commas.
function read_fields(    type) {
  type = take_name("a type")
  if (broken) return
  if (!(type in bytes)) {
    --next_token
    fail(here(), "the type \"" type "\" is none of int8_t, int16_t, int32_t, int64_t, float, double, " \
                 "boolean, byte, string")
    return
  }
  read_field(type)
  while (!broken && word() == ",") {
    ++next_token
    read_field(type)
  }
  take(";")
}

function read_field(type,    name, key, length_name) {
  name = take_name("the name of a field")
  if (broken) return
  if (name in field_at) {
    --next_token
    fail(here(), "a second field \"" name "\"")
    return
  }
  key = (messages + 1) SUBSEP fields
  field_name[key] = name
  field_type[key] = type
  field_elements[key] = 1
  field_length[key] = -1
  field_is_length[key] = 0
  if (word() == "[") {
    ++next_token
    length_name = word()
    if (length_name ~ /^[1-9][0-9]*$/) {
      field_elements[key] = length_name
    } else if (!(length_name in field_at)) {
      fail(here(), "the length \"" length_name "\" is no number and no field before this one")
    } else {
      field_length[key] = field_at[length_name]
      length_name = (messages + 1) SUBSEP field_at[length_name]
      if (field_type[length_name] != "int32_t" || field_is_array[length_name])
        fail(here(), "a length must be one int32_t")
      field_is_length[length_name] = 1
    }
    ++next_token
    take("]")
    field_is_array[key] = 1
    if (!broken && word() == "[") fail(here(), "arrays have one dimension")
  }
  field_at[name] = fields++
}

# accel_counts_t -> kAccelCountsFields
function table_name(type,    name, parts, n, i) {
  sub(/_t$/, "", type)
  n = split(type, parts, "_")
  for (i = 1; i <= n; ++i) name = name toupper(substr(parts[i], 1, 1)) substr(parts[i], 2)
  return "k" name "Fields"
}

function write_header(    m, i, key) {
  print "// Generated by cmake/lcm-layouts.awk from lcmtypes/*.lcm." > out
  print "#pragma once\n" > out
  for (m = 1; m <= messages; ++m) print "#include <framewatch/" message_name[m] ".hpp>" > out
  print "\n#include \"drivers/lcm/message_layout.h\"\n" > out
  print "namespace framewatch::drivers {\n" > out
  for (m = 1; m <= messages; ++m) {
    print "inline constexpr FieldLayout " table_name(message_name[m]) "[] = {" > out
    for (i = 0; i < message_fields[m]; ++i) {
      key = m SUBSEP i
      printf "    {\"%s\", %d, %s, %d, %s},\n", field_name[key], bytes[field_type[key]],
        field_elements[key], field_length[key], field_is_length[key] ? "true" : "false" > out
    }
    print "};" > out
  }
  print "\ninline constexpr MessageLayout kMessageLayouts[] = {" > out
  for (m = 1; m <= messages; ++m)
    printf "    {\"%s\", &%s::getHash, \"%s\", %s},\n", message_name[m], message_name[m],
      message_channel[m], table_name(message_name[m]) > out
  print "};\n\n}  // namespace framewatch::drivers" > out
}
