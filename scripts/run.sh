#!/usr/bin/env bash
# Installs what is missing, builds the one program it needs, sends a built-in scene through the accelerator
# and makes a page of its report.
# Any arguments are handed to `streaminggs simulate` in place of the built-in job.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
programs=(streaminggs)
# The other commands must not stay those of older sources.
if [ -e build/release/bin/streaminggs-commands ]; then programs+=(streaminggs-commands); fi
scripts/setup.sh release "${programs[@]}"
if [ $# -gt 0 ]; then
  exec build/release/bin/streaminggs simulate "$@"
fi
out=out/first_frame
build/release/bin/streaminggs simulate 'builtin:object?n=60000' --view 0 --out "$out"
# The waveform of a whole frame is large: a small one is enough to look at.
build/release/bin/streaminggs simulate 'builtin:object?n=3000' --view 0 --size 64x36 \
  --set group_width_px=32 --set group_height_px=12 \
  --vcd "$out/small_frame.vcd" --out "$out/small_frame" >/dev/null
scripts/report.py "$out" --out "$out/report.html" >/dev/null
cat <<TEXT

Open
  $out/report.html            the report as a page: pictures, times, energy, area, traffic
Beside it are
  $out/view_0/frame.png       the frame, read back from the modelled DRAM
  $out/view_0/reference.png   the reference renderer's
  $out/view_0/error.png       their difference: black where there is none, a legend beside it
  $out/view_0/report.json     every number, explained in testbench/streaminggs/REPORT.md
  $out/small_frame.vcd        a waveform: gtkwave $out/small_frame.vcd traces/accelerator.gtkw
TEXT
