#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# make bench: figures of speed and memory beside the bars that were set for them. Not a test: it fails only where nothing can be measured.
# Speeds are rays in a second of wall time, as the report tells them; the column "processor" divides by processor time instead, which
# other work on the machine disturbs less. For steady figures leave the machine alone.
box=$srcdir/scenes/cornell-box.scn
out=$TMPDIR/bench.json
processors=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)

value() { sed -n 's/^ *"'"$1"'": *"\{0,1\}\([^",]*\)"\{0,1\},\{0,1\}$/\1/p' "$out" | head -n 1; }
median() { sort -g | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }
most() { sort -g | tail -n 1; }
compute() { awk "BEGIN { printf \"$1\", $2 }"; }

# render SCENE ARGUMENT...: sets rays (a second, in millions), processor (the same of processor time)
render()
{
    "$MCRENDER" "$1" --quiet -o "$TMPDIR/bench.ppm" --report "$out" "${@:2}" || exit 1
    rays=$(compute %.3f "$(value rays_per_second) / 1e6")
    processor=$(compute %.3f "$(value rays) / $(value render_cpu) / 1e6")
}

sets=baseline
for set in avx2 avx512; do "$MCRENDER" check --quiet --isa $set "$box" 2>/dev/null && sets="$sets $set"; done
cornell=(--depth 50 --sampler 'mixture(cosine 1, light 1)' --accel list --size 512x512 --spp 16)

echo "$("$MCRENDER" --version), $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $processors processors"
echo
echo "Cornell box, 512 x 512, 16 spp, depth 50, mixture(cosine 1, light 1), list, one thread; million rays/s, 5 interleaved runs"
for run in 1 2 3 4 5; do
    for set in $sets; do
        render "$box" "${cornell[@]}" --threads 1 --isa $set
        echo "$rays" >>"$TMPDIR/$set.rays"
        echo "$processor" >>"$TMPDIR/$set.processor"
    done
done
printf '  %-10s %8s %8s %10s %22s   %s\n' set best median processor 'over baseline' bar
for set in $sets; do
    case $set in avx512) bar=25 ;; avx2) bar=15 ;; *) bar=- ;; esac
    best=$(most <"$TMPDIR/$set.rays")
    printf '  %-10s %8.2f %8.2f %10.2f %9.2f (processor %.2f)   %s\n' $set "$best" "$(median <"$TMPDIR/$set.rays")" "$(most <"$TMPDIR/$set.processor")" \
        "$(compute %.3f "$best / $(most <"$TMPDIR/baseline.rays")")" \
        "$(compute %.3f "$(most <"$TMPDIR/$set.processor") / $(most <"$TMPDIR/baseline.processor")")" "$bar"
done

echo
echo "Stages of one thread, $set (--profile)"
render "$box" "${cornell[@]}" --threads 1 --profile
sed -n '/"stages": {/,/}/p' "$out" | sed -n 's/^ *"\([a-z]*\)": \([0-9.e+-]*\),*$/\1 \2/p' |
    awk -v rays="$(value rays)" '{ name[NR] = $1; t[NR] = $2; sum += $2 }
        END { for (i = 1; i <= NR; i++) if (t[i] > 0) printf "  %-10s %5.1f %%  %6.2f ns a ray\n", name[i], 100 * t[i] / sum, 1e9 * t[i] / rays }'

echo
echo "Threads; million rays/s, the best of 3"
one=
for threads in $(for t in 1 2 4 8 16 32 64 "$processors"; do [ $t -le "$processors" ] && echo $t; done | sort -nu); do
    best=$(for run in 1 2 3; do render "$box" "${cornell[@]}" --threads $threads; echo "$rays"; done | most)
    one=${one:-$best}
    printf '  %-4s %8.2f   %.2f times one thread\n' $threads "$best" "$(compute %.3f "$best / $one")"
done

echo
echo "Paths in a batch (--batch), one thread; million rays/s, the best of 3"
for batch in 64 128 256 512 1024 2048 4096 16384; do
    best=$(for run in 1 2 3; do render "$box" "${cornell[@]}" --spp 8 --threads 1 --batch $batch; echo "$rays"; done | most)
    printf '  %-6s %8.2f\n' $batch "$best"
done

# crowd N KIND: a room with N small shapes at pseudorandom places in it
crowd()
{
    sed -n '/^quad/p; /^material/p; /^camera/,/^}/p' "$box" | sed '1i mcrender 1\nlet room = 555' | sed '/^box/,$d'
    awk -v n="$1" -v kind="$2" 'function random() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
        function place() { return sprintf("(%.3f, %.3f, %.3f)", x + 40 * random(), y + 40 * random(), z + 40 * random()) }
        BEGIN { seed = 4711
            for (i = 0; i < n; i++) {
                x = 30 + 460 * random(); y = 30 + 400 * random(); z = 30 + 460 * random()
                if (kind == "sphere") printf "sphere { center (%.3f, %.3f, %.3f) radius %.3f material white }\n", x, y, z, 5 + 20 * random()
                else printf "triangle { a %s b %s c %s material white }\n", place(), place(), place()
            } }'
}
echo
echo "list against bvh, one thread: a room of 6 quads and N shapes, 256 x 256, 4 spp; million rays/s, the best of 3 interleaved runs"
printf '  %-10s %5s %8s %8s %10s   %s\n' shapes N list bvh 'bvh/list' "auto chooses"
for kind in sphere triangle; do
    for n in 4 16 24 32 48 64 96 128 256 512 1024 2048; do
        crowd $n $kind >"$TMPDIR/crowd.scn"
        : >"$TMPDIR/list.rays"
        : >"$TMPDIR/bvh.rays"
        for run in 1 2 3; do
            for accel in list bvh; do
                render "$TMPDIR/crowd.scn" --size 256x256 --spp 4 --depth 50 --threads 1 --sampler 'mixture(cosine 1, light 1)' --accel $accel
                echo "$rays" >>"$TMPDIR/$accel.rays"
            done
        done
        render "$TMPDIR/crowd.scn" --size 8x8 --spp 1 --accel auto
        list=$(most <"$TMPDIR/list.rays") bvh=$(most <"$TMPDIR/bvh.rays")
        printf '  %-10s %5s %8.2f %8.2f %10.2f   %s\n' $kind $n "$list" "$bvh" "$(compute %.3f "$bvh / $list")" "$(value accelerator)"
        clear=$(compute %d "($bvh > 1.3 * $list)")
        [ "$clear" = 0 ] || break # the list only gets slower
    done
done

echo
echo "Many emitters: a room under a ceiling of N panels, nee, one thread, 64 x 64, 16 spp; processor time of a sample, the best of 3"
printf '  %-8s %10s %14s\n' N microseconds 'over the last'
last=
for side in 4 5 10 32 100 316; do
    { sed -n '/^quad/p; /^material/p; /^camera/,/^}/p' "$box" | sed '1i mcrender 1\nlet room = 555' | sed '/lamp }$/d'
      awk -v n=$side 'BEGIN { s = 500 / n; for (i = 0; i < n * n; i++)
          printf "quad { corner (%.9g, 554, %.9g) u (%.9g, 0, 0) v (0, 0, %.9g) material lamp }\n", 25 + s * int(i / n), 25 + s * (i % n), s * 0.9, s * 0.9 }'
    } >"$TMPDIR/panels.scn"
    best=$(for run in 1 2 3; do
        render "$TMPDIR/panels.scn" --sampler nee --depth 4 --threads 1 --size 64x64 --spp 16
        compute '%.4f\n' "1e6 * $(value render_cpu) / (64 * 64 * 16)"
    done | sort -g | head -n 1)
    printf '  %-8s %10.2f %14.2f\n' $((side * side)) "$best" "$(compute %.3f "$best / ${last:-$best}")"
    last=$best
done

echo
for i in $(seq 20); do
    start=$EPOCHREALTIME
    "$MCRENDER" check --quiet "$box"
    compute '%.3f\n' "($EPOCHREALTIME - $start) * 1000"
done >"$TMPDIR/check"
printf 'mcrender check on the Cornell box: %.2f ms (median of 20; bar: 5 ms)\n' "$(median <"$TMPDIR/check")"
for threads in $(printf '%s\n' 1 "$processors" | sort -nu); do
    render "$box" --size 512x512 --spp 4 --threads "$threads"
    printf 'peak memory at 512 x 512, PPM, %s threads: %.1f MB (bar: 64 MB)\n' "$threads" "$(compute %.3f "$(value peak_memory) / 1e6")"
done
