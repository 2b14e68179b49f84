#!/bin/bash
# Writes the manual page and the Bash completion of the program, from its own help texts:
# FOLDER/remomask.1 and FOLDER/remomask.bash.
#   tools/make_pages.sh PROGRAM FOLDER
set -euo pipefail
program=$1
folder=$2
mkdir -p "$folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Names of the subcommands in a help text.
subcommands() { awk '/^Subcommands:/ { on = 1; next } /^[^ ]/ || /^$/ { on = 0 } on && /^  [a-z]/ { print $1 }'; }
# The options in a help text, one a line.
options() { awk '/^  -/ { split($1, name, ","); for (i in name) if (name[i] ~ /^-/) print name[i] }' | sort -u; }

# A help text with its headings as sections of a manual page.
to_manual() {
  awk '
    function escaped(text) { gsub(/\\/, "\\e", text); gsub(/-/, "\\-", text); sub(/^[.\x27]/, "\\\\\\&&", text); return text }
    # An option and its meaning in two columns: the second begins after two spaces.
    /^  [^ ]/ && match(substr($0, 3), /   *[^ ]/) && !example {
      print ".TP"; print ".B " escaped(substr($0, 3, RSTART - 1))
      print escaped(substr($0, RSTART + RLENGTH + 1)); next
    }
    /^  [^ ]/ && example { print ".br"; print escaped(substr($0, 3)); next }
    /^  [^ ]/ { print ".TP"; print ".B " escaped(substr($0, 3)); next }
    /^[A-Z][a-z]*:$/ { example = /^Example/; print ".PP"; print ".I " escaped($0); next }
    /^$/ { print ".PP"; next }
    { sub(/^ +/, ""); print escaped($0) }'
}

paths=$("$program" --help | subcommands)
for command in $paths; do
  for sub in $("$program" "$command" --help | subcommands); do
    paths="$paths
$command $sub"
  done
done
paths=$(sort <<<"$paths")

{
  version=$("$program" --version | sed -n '1s/.*[^0-9.]\([0-9][0-9.]*\).*/\1/p;1s/^\([0-9][0-9.]*\)$/\1/p')
  echo ".TH REMOMASK 1 \"\" \"remomask ${version}\" \"User Commands\""
  echo ".SH NAME"
  echo "remomask \\- text to human motion, with a searchable motion database"
  echo ".SH DESCRIPTION"
  "$program" --help | to_manual
  while read -r path; do
    echo ".SH remomask ${path//-/\\-}"
    # shellcheck disable=SC2086
    "$program" $path --help | to_manual
  done <<<"$paths"
  echo ".SH ENVIRONMENT"
  echo ".TP"
  echo ".B REMOMASK_MODELS"
  echo "Folder of the shipped models and database, in place of the installed one."
} >"$work/remomask.1"

{
  cat <<'HEAD'
# Bash completion of remomask. Made from the program's help texts: do not edit.
_remomask_words() {
  case "$1" in
HEAD
  echo "    '') echo '$( ("$program" --help | subcommands; "$program" --help | options) | xargs)' ;;"
  while read -r path; do
    # shellcheck disable=SC2086
    words=$( ("$program" $path --help | subcommands; "$program" $path --help | options) | xargs)
    echo "    '$path') echo '$words' ;;"
  done <<<"$paths"
  cat <<'TAIL'
  esac
}

_remomask() {
  local current=${COMP_WORDS[COMP_CWORD]} command='' word
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word == -* ]] && continue
    # Two levels at most; what is no command of the level is a value or a file.
    if [[ -n $(_remomask_words "${command:+$command }$word") ]]; then
      command="${command:+$command }$word"
    fi
  done
  local words
  words=$(_remomask_words "$command")
  # Options only when one is begun: elsewhere commands and files are more useful.
  [[ $current == -* ]] || words=$(tr ' ' '\n' <<<"$words" | grep -v '^-' || true)
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  [[ ${#COMPREPLY[@]} -gt 0 ]] || mapfile -t COMPREPLY < <(compgen -f -- "$current")
}
complete -o filenames -F _remomask remomask
TAIL
} >"$work/remomask.bash"
mv "$work/remomask.1" "$work/remomask.bash" "$folder/"
