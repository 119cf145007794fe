# SPDX-License-Identifier: Apache-2.0
# What all scripts of farms have; the variables are set above it (farm_script.cpp).

# begin: makes the folder, and says in it what is planned, for `vernier farm status`.
begin() {
  mkdir -p "$folder"
  local new
  new=$(mktemp "$folder/plan.XXXXXX")
  printf '%s\n' "$plan" > "$new"
  chmod 644 "$new"
  mv -f "$new" "$folder/farm.json"
}
