# SPDX-License-Identifier: Apache-2.0
# Parts of one picture: each renders it by a seed of its own, and the merge adds their samples up.

# read_goal ROUND: sets `samples` to the samples a pixel, of all parts together, that a round goes on to: those of the
# plan, then as many as the merge before has found to be needed. 0: the error asked for is reached.
read_goal() {
  samples=$spp
  if (($1 == 1)); then return; fi
  if [[ ! -f $folder/goal.$1 ]]; then
    echo "error: $folder/goal.$1: is not there; the merge of round $(($1 - 1)) writes it" >&2
    exit 3
  fi
  samples=$(< "$folder/goal.$1")
  if ((most_spp > 0 && samples > most_spp)); then samples=$most_spp; fi
}

# part_command ROUND PART: sets `command` to what renders the part, or goes on with it; to nothing when nothing is left.
part_command() {
  local round=$1 part=$2 samples file=$folder/part.$2.ckpt
  command=()
  read_goal "$round"
  if ((round > 1 && samples == 0)); then return; fi
  command=("$vernier" render "${render[@]}" --seed "$((first_seed + part - 1))" --checkpoint "$file" --resume "$file")
  if ((samples > 0)); then command+=(--spp "$((samples / parts + (part <= samples % parts)))"); fi
}

# merge_command ROUND: sets `command` to what puts the parts together, or to nothing when the picture is there.
merge_command() {
  local round=$1 part samples
  command=()
  read_goal "$round"
  if ((round > 1 && samples == 0)); then return; fi
  command=("$vernier" merge)
  for ((part = 1; part <= parts; ++part)); do command+=("$folder/part.$part.ckpt"); done
  command+=("${merge[@]}")
  if ((round < rounds)); then command+=(--goal "$folder/goal.$((round + 1))"); fi
}
