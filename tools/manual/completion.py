"""Completion for bash, zsh and fish, from what the programs say of themselves."""

import re
import shlex


def _takes(option):
    """What comes after an option: nothing, one of a few words, a number, or a file."""
    if not option.value:
        return "nothing"
    return "choices" if option.choices else "number" if option.is_number else "file"


def bash(program, commands):
    main, *subcommands = commands
    function = f"_{program}"
    lines = [f"# Completion of {program} for bash.", f"{function}() {{",
             "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} words= choices=",
             "  case ${COMP_WORDS[1]-} in"]
    for command in subcommands + [main]:
        words = " ".join(name for option in command.options if not option.positional
                         for name in option.names if name.startswith("--"))
        lines.append(f"    {command.name or '*'})")
        lines.append(f"      words={shlex.quote(words)}")
        after = [option for option in command.options if _takes(option) in ("choices", "number")
                 and not option.positional]
        if after:
            lines.append("      case $previous in")
            for option in after:
                if _takes(option) == "choices":
                    lines.append(f"        {option.names[-1]}) choices={shlex.quote(' '.join(option.choices))} ;;")
            numbers = "|".join(option.names[-1] for option in after if _takes(option) == "number")
            if numbers:
                lines.append(f"        {numbers}) compopt +o default +o bashdefault; return ;;")
            lines.append("      esac")
        lines.append("      ;;")
    lines.append("  esac")
    if subcommands:
        names = " ".join(command.name for command in subcommands)
        lines += ["  if [ \"$COMP_CWORD\" -eq 1 ]; then", f"    choices=\"{names} $words\"", "  fi"]
    lines += ["  if [ -z \"$choices\" ] && [[ $current == -* ]]; then choices=$words; fi",
              "  # Nothing of ours fits: bash completes names of files.",
              "  mapfile -t COMPREPLY < <(compgen -W \"$choices\" -- \"$current\")",
              "}", f"complete -o bashdefault -o default -F {function} {program}"]
    return "\n".join(lines) + "\n"


def fish(program, commands):
    main, *subcommands = commands
    lines = [f"# Completion of {program} for fish."]
    for command in subcommands:
        lines.append(f"complete -c {program} -n __fish_use_subcommand -f -a {command.name} "
                     f"-d {_fish_quote(command.text)}")
    for command in commands:
        when = f" -n '__fish_seen_subcommand_from {command.name}'" if command.name else (
            " -n __fish_use_subcommand" if subcommands else "")
        for option in command.options:
            if option.positional:
                continue
            line = f"complete -c {program}{when}"
            for name in option.names:
                line += f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}"
            line += {"nothing": "", "file": " -r -F", "number": " -x",
                     "choices": f" -x -a {_fish_quote(' '.join(option.choices))}"}[_takes(option)]
            lines.append(f"{line} -d {_fish_quote(option.text)}")
    return "\n".join(lines) + "\n"


def _fish_quote(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def zsh(program, commands):
    main, *subcommands = commands
    lines = [f"#compdef {program}", f"# Completion of {program} for zsh."]
    if not subcommands:
        return "\n".join(lines + ["_arguments -s \\", " \\\n".join(_zsh_arguments(main))]) + "\n"
    lines += ["if (( CURRENT == 2 )); then", "  local -a commands=("]
    for command in subcommands:
        lines.append("    " + shlex.quote(f"{command.name}:{command.text.replace(':', ';')}"))
    lines += ["  )", f"  _describe command commands", "  _arguments \\",
              " \\\n".join(_zsh_arguments(main)), "  return", "fi", "local name=$words[2]", "shift words",
              "(( CURRENT-- ))", "case $name in"]
    for command in subcommands:
        lines += [f"  {command.name})", "    _arguments -s \\", " \\\n".join(_zsh_arguments(command)), "    ;;"]
    return "\n".join(lines + ["esac"]) + "\n"


def _zsh_arguments(command):
    entries = []
    for option in command.options:
        text = re.sub(r"([\[\]:\\])", r"\\\1", option.text)
        value = {"nothing": "", "file": ":file:_files", "number": ":number:",
                 "choices": f":choice:({' '.join(option.choices)})"}[_takes(option)]
        if option.positional:
            entries.append(f"*:{option.names[0]}:_files" if option.repeats else f":{option.names[0]}:_files")
            continue
        star = "*" if option.repeats else ""
        entries += [f"{star}{name}[{text}]{value}" for name in option.names]
    return ["    " + shlex.quote(entry) for entry in entries]
