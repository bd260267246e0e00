#!/bin/bash
# window_test.sh PREVIEW MAKE_BALL: drives the window under Xvfb as a hand would: two screenshots around a drag must differ,
# neither may be blank, and a key closes it with exit code 0. Exit code 77: left out.
preview=$1
make_ball=$2
for tool in xvfb-run xdotool; do
  if ! command -v "$tool" >/dev/null; then
    echo "left out: $tool is not installed"
    exit 77
  fi
done
if [ -z "$INSIDE_XVFB" ]; then
  INSIDE_XVFB=1 exec xvfb-run -a -s "-screen 0 1024x768x24" bash "$0" "$@"
fi

folder=$(mktemp -d)
trap 'kill "$program" 2>/dev/null; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
fail() {
  echo "FAILED: $*"
  cat preview.log
  exit 1
}
wait_for() {  # wait_for FILE: until it is there, at most 40 s
  for _ in $(seq 400); do
    [ -s "$1" ] && return 0
    kill -0 "$program" 2>/dev/null || fail "the program ended early"
    sleep 0.1
  done
  fail "$1 did not appear"
}

"$make_ball" ball.vdb || exit 1
"$preview" ball.vdb --window-size 480x320 2>preview.log &
program=$!
window=
for _ in $(seq 400); do
  window=$(xdotool search --pid "$program" --name Nephele 2>/dev/null | head -1)
  [ -n "$window" ] && break
  kill -0 "$program" 2>/dev/null || fail "the program ended early"
  sleep 0.1
done
[ -n "$window" ] || fail "no window appeared"
xdotool windowfocus "$window" 2>/dev/null
sleep 1
xdotool key h
xdotool key F12
wait_for nephele_0001.png
read -r x y < <(xdotool getwindowgeometry --shell "$window" | awk -F= '/^X=/{x=$2} /^Y=/{y=$2} END{print x, y}')
xdotool mousemove $((x + 300)) $((y + 160)) mousedown 1
for step in 20 40 60 80 100; do
  xdotool mousemove $((x + 300 - step)) $((y + 160 + step / 3))
  sleep 0.1
done
xdotool mouseup 1
sleep 1
xdotool key F12
wait_for nephele_0002.png
# A picture of one colour compresses to below 2000 bytes; these hold a shaded ball under a smooth sky.
for picture in nephele_0001.png nephele_0002.png; do
  size=$(stat -c %s $picture)
  echo "$picture: $size bytes"
  [ "$size" -gt 3000 ] || fail "$picture is blank"
done
cmp -s nephele_0001.png nephele_0002.png && fail "the drag changed nothing"
# A tiny window and back must not end the program.
xdotool windowsize "$window" 1 1
sleep 0.5
xdotool windowsize "$window" 480 320
sleep 0.5
xdotool key F1
sleep 0.3
xdotool key F1
sleep 0.3
xdotool key Escape
wait "$program"
code=$?
[ "$code" -eq 0 ] || fail "exit code $code"
[ -z "$(find . -name imgui.ini)" ] || fail "a file was left behind"
echo "the window opens, turns, takes screenshots and closes"
