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
             "  local command=${COMP_WORDS[1]-}"]
    for command in subcommands:
        if command.subcommands:
            lines.append(f"  if [ \"$command\" = {command.name} ] && [ \"$COMP_CWORD\" -gt 2 ]; then "
                         "command+=\" ${COMP_WORDS[2]}\"; fi")
    lines.append("  case $command in")
    for command in subcommands + [main]:
        words = " ".join(name for option in command.options if not option.positional
                         for name in option.names if name.startswith("--"))
        lines.append(f"    {shlex.quote(command.name) if command.name else '*'})")
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
        if command.name and command.subcommands:
            lines.append(f"      if [ \"$COMP_CWORD\" -eq 2 ]; then choices=\"{' '.join(command.subcommands)} $words\"; fi")
        lines.append("      ;;")
    lines.append("  esac")
    if subcommands:
        names = " ".join(main.subcommands)
        lines += ["  if [ \"$COMP_CWORD\" -eq 1 ]; then", f"    choices=\"{names} $words\"", "  fi"]
    lines += ["  if [ -z \"$choices\" ] && [[ $current == -* ]]; then choices=$words; fi",
              "  # Nothing of ours fits: bash completes names of files.",
              "  mapfile -t COMPREPLY < <(compgen -W \"$choices\" -- \"$current\")",
              "}", f"complete -o bashdefault -o default -F {function} {program}"]
    return "\n".join(lines) + "\n"


def fish(program, commands):
    main, *subcommands = commands
    lines = [f"# Completion of {program} for fish."]
    verbs = {command.name: " ".join(command.subcommands) for command in subcommands if command.subcommands}
    for command in subcommands:
        group, _, verb = command.name.rpartition(" ")
        when = (f"'__fish_seen_subcommand_from {group}; and not __fish_seen_subcommand_from {verbs[group]}'" if group
                else "__fish_use_subcommand")
        lines.append(f"complete -c {program} -n {when} -f -a {verb} -d {_fish_quote(command.text)}")
    for command in commands:
        seen = "; and ".join(f"__fish_seen_subcommand_from {word}" for word in command.name.split())
        when = f" -n '{seen}'" if command.name else (" -n __fish_use_subcommand" if subcommands else "")
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
    lines += _zsh_names(subcommands, "")
    lines += ["  )", f"  _describe command commands", "  _arguments \\",
              " \\\n".join(_zsh_arguments(main)), "  return", "fi", "local name=$words[2]", "shift words",
              "(( CURRENT-- ))"]
    for command in subcommands:
        if command.subcommands:
            lines += [f"if [[ $name == {command.name} ]]; then", "  if (( CURRENT == 2 )); then",
                      "    local -a verbs=("] + _zsh_names(subcommands, command.name) + [
                      "    )", "    _describe verb verbs", "    return", "  fi", f"  name=\"{command.name} $words[2]\"",
                      "  shift words", "  (( CURRENT-- ))", "fi"]
    lines.append("case $name in")
    for command in subcommands:
        lines += [f"  {shlex.quote(command.name)})", "    _arguments -s \\", " \\\n".join(_zsh_arguments(command)), "    ;;"]
    return "\n".join(lines + ["esac"]) + "\n"


def _zsh_names(subcommands, group):
    """Those of one level, with what they are for."""
    names = []
    for command in subcommands:
        parent, _, name = command.name.rpartition(" ")
        if parent == group:
            names.append("    " + shlex.quote(f"{name}:{command.text.replace(':', ';')}"))
    return names


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
