#!/usr/bin/env python3
"""Writes the manual pages and the shells' completions, from the templates in this folder and from what the programs
and the example configuration say of themselves: so none of them can fall behind.

usage: manual.py --version V --date DATE --config TOML --out FOLDER --facewire COMMAND... --facewired COMMAND...
"""

import argparse
import pathlib

import completion
import help_text
import pages


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", required=True)
    parser.add_argument("--date", required=True)
    parser.add_argument("--config", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    # More than one word each: an emulator runs what was cross-built.
    parser.add_argument("--facewire", nargs="+", required=True)
    parser.add_argument("--facewired", nargs="+", required=True)
    arguments = parser.parse_args()

    facewire = help_text.read(arguments.facewire)
    facewired = help_text.read(arguments.facewired)
    parts = {
        "@version@": arguments.version,
        "@date@": arguments.date,
        "@commands@": pages.commands(facewire[1:]),
        "@facewire options@": pages.options(facewire[0]),
        "@facewired options@": pages.options(facewired[0]),
        "@keys@": pages.keys(arguments.config.read_text(encoding="utf-8")),
    }
    arguments.out.mkdir(parents=True, exist_ok=True)
    for template in sorted(pathlib.Path(__file__).parent.glob("*.in")):
        text = template.read_text(encoding="utf-8")
        for name, part in parts.items():
            text = text.replace(name, part)
        (arguments.out / template.stem).write_text(text, encoding="utf-8")
    for program, commands in (("facewire", facewire), ("facewired", facewired)):
        (arguments.out / f"{program}.bash").write_text(completion.bash(program, commands), encoding="utf-8")
        (arguments.out / f"{program}.fish").write_text(completion.fish(program, commands), encoding="utf-8")
        (arguments.out / f"_{program}").write_text(completion.zsh(program, commands), encoding="utf-8")


if __name__ == "__main__":
    main()
