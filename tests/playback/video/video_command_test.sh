#!/usr/bin/env bash
# Films of weft render: frames, size and duration as ffprobe counts them, errors, and files left behind.
# Usage: video_command_test.sh WEFT (exit status 77: ffmpeg is not here; what needs none is checked all the same)
weft=$1
source "$(dirname -- "${BASH_SOURCE[0]}")/../../apps/command_checks.sh"

without_programs() { PATH=/no/such/folder exits "$@"; }
one_line() { [ "$(wc -l <err)" -eq 1 ] && grep -q -- "$1" err; }
is() { [ "$1" = "$2" ] || { echo "'$1', expected '$2'"; return 1; }; }
no_film() { [ -z "$(find . -name '*.mp4' -o -name '*.gif' -o -name '.weft*')" ]; }
probe() { ffprobe -v error -count_frames -select_streams v -show_entries "stream=$2" -of csv=p=0 "$1"; }
seconds() { ffprobe -v error -show_entries format=duration -of csv=p=0 "$1"; }

check "run" exits 0 run hang --engine reference --duration "0.4 s" -o hang.weftrec
check "run another" exits 0 run hang --engine reference --duration "0.4 s" --time-step "0.001 s" -o other.weftrec
small=(--size 96x54)

# Bad input: one line, exit code 2, no film
check "no ffmpeg" without_programs 2 render hang.weftrec --video a.mp4 "${small[@]}"
check "no ffmpeg: says what was expected" one_line "ffmpeg cannot be started.*expected it in PATH"
check "neither picture nor film" exits 2 render hang.weftrec
check "picture and film" exits 2 render hang.weftrec -o a.png --video a.mp4
check "another ending" exits 2 render hang.weftrec --video a.avi
check "another ending: says so" one_line "expected a name that ends with .mp4 or .gif"
check "film of all" exits 2 render hang.weftrec --video a.mp4 --all
check "a turn without a film" exits 2 render hang.weftrec -o a.png --turntable
check "a rate without a unit" exits 2 render hang.weftrec --video a.mp4 --frame-rate 25
check "a rate of none" exits 2 render hang.weftrec --video a.mp4 --frame-rate "0 Hz"
check "a duration without --time" exits 2 render hang.weftrec --video a.mp4 --duration "2 s"
check "too many pictures" exits 2 render hang.weftrec --video a.mp4 --time "0 s" --duration "1e9 s"
check "an unknown camera" exits 2 render hang.weftrec --video a.mp4 --camera above
check "difference of one" exits 2 render hang.weftrec --video a.mp4 --style difference
check "difference of one: says so" one_line "expected a second recording (--beside)"
check "no folder" exits 2 render hang.weftrec --video gone/a.mp4 "${small[@]}"
check "nothing was written" no_film

# Pictures of two recordings and other cameras need no ffmpeg.
check "side by side" without_programs 0 render hang.weftrec --beside other.weftrec -o beside.png "${small[@]}"
check "difference" without_programs 0 render hang.weftrec --beside other.weftrec --style difference -o difference.png "${small[@]}"
check "another camera" without_programs 0 render hang.weftrec --camera top -o top.png "${small[@]}"
check "the scene's camera" without_programs 0 render hang.weftrec -o own.png "${small[@]}"
check "cameras differ" test "$(cksum <top.png)" != "$(cksum <own.png)"
check "run a smaller one" exits 0 run drape_sphere --engine reference --duration "0.02 s" -o drape.weftrec
check "difference of two scenes" exits 2 render hang.weftrec --beside drape.weftrec --style difference -o no.png
check "difference of two scenes: says why" one_line "drape.weftrec: .*expected"

if ! command -v ffmpeg >/dev/null || ! command -v ffprobe >/dev/null; then
  echo "$checks checks, $failures failed; skipped the others: ffmpeg is not here (Debian: ffmpeg)"
  [ "$failures" -eq 0 ] && exit 77
  exit 1
fi

frames=$("$weft" info --json hang.weftrec | grep -o '"frames": *[0-9]*' | grep -o '[0-9]*')
check "film" exits 0 render hang.weftrec --video a.mp4 "${small[@]}"
check "as many frames as the recording" is "$(probe a.mp4 nb_read_frames)" "$frames"
check "its size and form" is "$(probe a.mp4 codec_name,width,height,pix_fmt)" "h264,96,54,yuv420p"
rate=$(probe a.mp4 r_frame_rate)
check "its own rate and length" awk -v rate="$rate" -v n="$frames" -v d="$(seconds a.mp4)" 'BEGIN {
  split(rate, r, "/"); real = 0.4; exit !(d - n / (r[1] / r[2]) < 0.002 && d > real && d < real + 2 / (r[1] / r[2])) }'
check "says what it has written" grep -q "a.mp4: $frames frames at " out
check "again, over its own film" exits 0 render hang.weftrec --video a.mp4 "${small[@]}" --frame-rate "10 Hz"
check "ten a second, in real time" is "$(probe a.mp4 r_frame_rate,nb_read_frames)" "10/1,5"
check "half as fast" exits 0 render hang.weftrec --video a.mp4 "${small[@]}" --frame-rate "10 Hz" --speed 0.5
check "half as fast: twice as many" is "$(probe a.mp4 nb_read_frames)" 9
check "gif" exits 0 render hang.weftrec --video a.gif "${small[@]}"
check "gif: size and rate" is "$(probe a.gif codec_name,width,height,nb_read_frames)" "gif,96,54,11"
check "gif: over its own film" exits 0 render hang.weftrec --video a.gif "${small[@]}"
check "gif: too fast" exits 2 render hang.weftrec --video b.gif "${small[@]}" --frame-rate "60 Hz"
check "turntable" exits 0 render hang.weftrec --video turn.mp4 "${small[@]}" --time "0.2 s" --turntable --duration "1 s" --frame-rate "8 Hz"
check "turntable: frames" is "$(probe turn.mp4 nb_read_frames)" 8
check "turntable: turns" test "$(cksum < <(ffmpeg -v error -i turn.mp4 -vf "select=eq(n\,0)" -frames:v 1 -f rawvideo -))" != \
  "$(cksum < <(ffmpeg -v error -i turn.mp4 -vf "select=eq(n\,2)" -frames:v 1 -f rawvideo -))"
check "side by side" exits 0 render hang.weftrec --beside other.weftrec --style shaded,difference --video both.mp4 "${small[@]}" --frame-rate "5 Hz"
check "side by side: three pictures wide" awk -v w="$(probe both.mp4 width)" 'BEGIN { exit !(w > 3 * 96 && w < 3.5 * 96) }'

# Colors survive: the first picture of the film is the picture of the first frame, up to compression.
check "a picture" exits 0 render hang.weftrec -o first.png --time "0 s" --size 320x180
check "a film" exits 0 render hang.weftrec --video first.mp4 --size 320x180 --frame-rate "5 Hz"
psnr=$(ffmpeg -v info -i first.mp4 -i first.png -lavfi "[0:v]select=eq(n\,0)[a];[a][1:v]psnr" -frames:v 1 -f null - 2>&1 | grep -o 'average:[0-9.]*' | cut -d: -f2)
check "colors are those of the picture (PSNR $psnr dB)" awk -v p="$psnr" 'BEGIN { exit !(p > 35) }'

# Other people's files, and a film that ffmpeg cannot make
echo "a film of mine" >mine.mp4
check "another film" exits 2 render hang.weftrec --video mine.mp4 "${small[@]}"
check "another film stays" is "$(cat mine.mp4)" "a film of mine"
mkdir programs
printf '#!/bin/sh\nhead -c 1000 >/dev/null\necho "no encoder today" >&2\nexit 1\n' >programs/ffmpeg
chmod +x programs/ffmpeg
before=$(cksum <a.mp4)
PATH="$work/programs:$PATH" "$weft" render hang.weftrec --video a.mp4 "${small[@]}" >out 2>err
check "ffmpeg fails: exit code" is $? 2
check "ffmpeg fails: its words" one_line "ffmpeg has failed: no encoder today"
check "ffmpeg fails: the earlier film stays" is "$(cksum <a.mp4)" "$before"
check "nothing is left behind" test -z "$(find . -name '.weft*')"

finish
