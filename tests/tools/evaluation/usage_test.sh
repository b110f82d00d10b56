#!/bin/bash
# Bad usage of tools/eval ends with 2 and says why, before anything is installed, built or written.
# usage: usage_test.sh EVAL SCRATCH_FOLDER
set -u
eval=$1
scratch=$2
mkdir -p "$scratch/data"
failed=0

# refuses WHAT_IT_SAYS ARGUMENT...
refuses() {
  local says=$1 said code=0
  shift
  said=$("$eval" "$@" 2>&1 >/dev/null) || code=$?
  if [ $code -ne 2 ] || [[ $said != *"$says"* ]]; then
    echo "tools/eval $*: ended with $code and said: $said" >&2
    failed=1
  fi
}

/usr/bin/env python3 -c 'import numpy' 2>/dev/null || /usr/bin/python3 -c 'import numpy' 2>/dev/null ||
  { echo "skipped: no python3 here has NumPy"; exit 77; }
refuses "DATA_FOLDER"
refuses "is no folder" "$scratch/nowhere"
refuses "is no file" "$scratch/data" --profile "$scratch/nothing.profile"
refuses "does not exist" "$scratch/data" --out "$scratch/nowhere/figures.md"
refuses "invalid choice" "$scratch/data" --only weather
refuses "unrecognized" "$scratch/data" --colour
exit $failed
