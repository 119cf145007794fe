# SPDX-License-Identifier: Apache-2.0
# Runs one task of an Open Job Description: FOLDER part ROUND PART, or FOLDER merge ROUND. Vernier takes the place of
# this shell, so that it is told when the task is canceled.

cd -- "$1"
begin
"$2_command" "${@:3}"
if ((${#command[@]} > 0)); then exec "${command[@]}"; fi
