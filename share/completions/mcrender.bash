# SPDX-License-Identifier: Apache-2.0
# Completion for bash. Options come from --help, plugins from `mcrender plugins`, so that nothing has to be kept in step.
# Installed as $(datadir)/bash-completion/completions/mcrender; or source it.

_mcrender_words() # program: the words of all plugins
{
    "$1" plugins 2>/dev/null | sed -n 's/^  \([a-z][a-z0-9_-]*\)  .*/\1/p'
}

_mcrender_compare() # program word before: into COMPREPLY
{
    case $3 in
    --encoding) mapfile -t COMPREPLY < <(compgen -W 'linear srgb8' -- "$2") ;;
    --map-kind) mapfile -t COMPREPLY < <(compgen -W 'signed absolute relative' -- "$2") ;;
    --fail-above) mapfile -t COMPREPLY < <(compgen -S = -W "$("$1" compare --help 2>/dev/null | sed -n 's/^Metrics: //p')" -- "$2") ;;
    --peak | --confidence | --map-range) ;;
    *)
        if [[ $2 == -* ]]; then
            mapfile -t COMPREPLY < <(compgen -W "$("$1" compare --help 2>/dev/null | grep -oE '^  -[-a-z]+' | tr -d ' ')" -- "$2")
        else
            mapfile -t COMPREPLY < <(compgen -f -- "$2")
        fi ;;
    esac
}

_mcrender()
{
    local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=
    COMPREPLY=()
    [ "$COMP_CWORD" -gt 1 ] && command=${COMP_WORDS[1]}
    case $before in
    --accel) mapfile -t COMPREPLY < <(compgen -W 'auto list bvh' -- "$word"); return ;;
    --isa) mapfile -t COMPREPLY < <(compgen -W 'baseline avx2 avx512' -- "$word"); return ;;
    --precision) mapfile -t COMPREPLY < <(compgen -W 'double' -- "$word"); return ;;
    --bits) mapfile -t COMPREPLY < <(compgen -W '8 16' -- "$word"); return ;;
    --sampler) mapfile -t COMPREPLY < <(compgen -W "$(_mcrender_words "$program")" -- "$word"); return ;;
    --plugin) mapfile -t COMPREPLY < <(compgen -f -X '!*.so' -- "$word"; compgen -d -- "$word"); return ;;
    -o | --report | --sample-map | --use-map) mapfile -t COMPREPLY < <(compgen -f -- "$word"); return ;;
    --tone) mapfile -t COMPREPLY < <(compgen -W 'linear reinhard hable aces' -- "$word"); return ;;
    --layers) mapfile -t COMPREPLY < <(compgen -W 'variance albedo normal depth id direct indirect' -- "$word"); return ;;
    --roulette) mapfile -t COMPREPLY < <(compgen -W 'on off' -- "$word"); return ;;
    --spp | --depth | --seed | --threads | --size | --crop | --batch | --time | --target-error | --round | --set | --exposure) return ;;
    esac
    if [ "$command" = compare ]; then
        _mcrender_compare "$program" "$word" "$before"
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$( ("$program" --help; [ "$command" != study ] || "$program" study --help) 2>/dev/null | grep -oE '  -[-a-z]+' | tr -d ' ')" -- "$word")
    elif [ "$command" = plugins ]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_mcrender_words "$program")" -- "$word")
    else
        mapfile -t COMPREPLY < <(compgen -f -X '!*.scn' -- "$word"; compgen -d -- "$word")
        [ "$COMP_CWORD" = 1 ] && mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W 'check compare explain plugins study' -- "$word")
    fi
}

complete -o filenames -F _mcrender mcrender
