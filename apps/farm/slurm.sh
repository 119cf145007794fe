# SPDX-License-Identifier: Apache-2.0
# Submits itself to Slurm: an array of parts, then the merge, which waits for it.

# submit OPTION... STAGE ROUND: prints the number of the job. Options of the plan come last, so that they win.
submit() {
  local options=("${@:1:$#-2}") job
  job=$(sbatch --parsable --requeue --open-mode=append --kill-on-invalid-dep=yes --job-name="vernier $name" \
    "${options[@]}" "${sbatch[@]}" "$script" "${@: -2}")
  echo "${job%%;*}"
}

submit_all() {
  local round job logs=${folder//%/%%} after=()
  for ((round = 1; round <= rounds; ++round)); do
    job=$(submit --array="1-$parts" --signal=B:USR2@60 --output="$logs/part.%a.log" "${after[@]}" part "$round")
    echo "submitted $parts parts as job $job"
    if [[ -v merge ]]; then
      job=$(submit --dependency="$merge_when:$job" --output="$logs/merge.log" merge "$round")
      echo "submitted their merge as job $job"
      after=(--dependency="afterok:$job")
    fi
  done
}

# Slurm sends SIGUSR2 to this shell alone, a minute before the time limit; then Vernier is told to stop and the job is
# queued again, to go on. SIGTERM, of scancel and preemption, goes to Vernier too: here it is only outlived.
run_part() {
  local process status stopped=0 signaled
  part_command "$1" "$SLURM_ARRAY_TASK_ID"
  if ((${#command[@]} == 0)); then return; fi
  "${command[@]}" --threads "${SLURM_CPUS_ON_NODE:-0}" &
  process=$!
  trap 'signaled=1; stopped=1; kill -TERM "$process"' USR2
  trap 'signaled=1' TERM
  while true; do
    signaled=0 status=0
    wait "$process" || status=$?
    if ((signaled == 0)); then break; fi # otherwise it was not Vernier that ended
  done
  if ((stopped && status == 5)); then
    echo "out of time; queued again to go on"
    scontrol requeue "$SLURM_JOB_ID"
  fi
  return "$status"
}

run_merge() {
  merge_command "$1"
  if ((${#command[@]} > 0)); then "${command[@]}" --threads "${SLURM_CPUS_ON_NODE:-0}"; fi
}

case ${1:-submit} in
  submit)
    script=$(realpath -- "$0")
    cd -- "$work"
    begin
    submit_all
    ;;
  part) run_part "$2" ;;
  merge) run_merge "$2" ;;
  *)
    echo "usage: bash $0, which submits all jobs" >&2
    exit 2
    ;;
esac
