# SPDX-License-Identifier: Apache-2.0
# On this machine, or on those of $HOSTS by GNU parallel.

script=$(realpath -- "$0")
cd -- "$work"

# Vernier takes the place of this shell, so that it is told when the part is to stop.
run_part() {
  part_command "$1" "$2"
  if ((${#command[@]} > 0)); then exec "${command[@]}"; fi
}

run_merge() {
  merge_command "$1"
  if ((${#command[@]} > 0)); then "${command[@]}"; fi
}

# Vernier ends with 5 when it was told to stop: what is done is kept, and nothing else is begun.
run_parts_here() {
  local round=$1 part status failed=0
  for ((part = 1; part <= parts; ++part)); do
    status=0
    bash "$script" part "$part" "$round" || status=$?
    if ((status == 5 || (status != 0 && ! skip_missing))); then return "$status"; fi
    if ((status != 0)); then failed=$((failed + 1)); fi
  done
  if ((failed > 0)); then echo "$failed of $parts parts failed; going on without them" >&2; fi
}

# A part whose machine dies is tried on another.
run_parts_on_hosts() {
  seq "$parts" | parallel --will-cite --sshlogin "$HOSTS" --workdir "$work" --jobs 1 --retries 3 --line-buffer \
    --tagstring 'part {}' --termseq TERM,60000,KILL,25 bash "$script" part {} "$1" || ((skip_missing))
}

run_all() {
  local round
  for ((round = 1; round <= rounds; ++round)); do
    if [[ -n ${HOSTS:-} ]]; then run_parts_on_hosts "$round"; else run_parts_here "$round"; fi
    if [[ -v merge ]]; then run_merge "$round"; fi
  done
}

begin
case ${1:-all} in
  all) run_all ;;
  part) run_part "${3:-1}" "$2" ;;
  merge) run_merge "${2:-$rounds}" ;;
  *)
    echo "usage: bash $0 [all | part NUMBER [ROUND] | merge [ROUND]]" >&2
    exit 2
    ;;
esac
