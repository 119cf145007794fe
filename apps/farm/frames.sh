# SPDX-License-Identifier: Apache-2.0
# Parts of an animation: each renders some of the frames. Those that are finished are left out when it begins again.

# part_command ROUND PART: sets `command` to what renders the part, or goes on with it.
part_command() {
  local file="$folder/{frame}.ckpt"
  command=("$vernier" render "${render[@]}" --frames "${frames[$2 - 1]}" --skip-existing
    --checkpoint "$file" --resume "$file" --drop-checkpoint)
}
