"""tools/manual: what programs say becomes manual pages and completions, whole.

usage: manual_test.py SOURCES MADE FACEWIRE FACEWIRED      MADE: what manual.py wrote for these programs
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCES, MADE = map(pathlib.Path, sys.argv[1:3])
PROGRAMS = {"facewire": sys.argv[3], "facewired": sys.argv[4]}
sys.path.insert(0, str(SOURCES / "tools/manual"))
import completion  # noqa: E402
import help_text  # noqa: E402
import pages  # noqa: E402

HELP = """What it does
Usage: program go [OPTIONS] INPUT [WHERE]

Positionals:
  INPUT TEXT REQUIRED             A video
  WHERE TEXT=/run/somewhere       The place

Options:
  -h,--help                       Print this help message and exit
  --model TEXT:{attention,mesh}=attention
                                  attention: exact; mesh: lighter
  --timeout FLOAT:FLOAT in [0.1 - 3600]=15
                                  Seconds to wait
  --blend FLOAT:FLOAT in [0 - 100] Needs: --personal
                                  How much it counts
  --rigid TEXT ... Excludes: --model
                                  Markers
  --out TEXT REQUIRED             The file to write; it is new,
                                  or written over
  --fast                          No waiting

Look at the camera.
"""


def fake_program(text):
    """A program whose --help is `text`."""
    file = tempfile.NamedTemporaryFile("w", suffix=".txt")
    file.write(text)
    file.flush()
    return file, ["sh", "-c", f"cat {file.name}"]


def options_of(text):
    file, program = fake_program(text)
    with file:
        [command] = help_text.read(program)
    return command, {option.names[-1]: option for option in command.options}


def unformatted(troff):
    return re.sub(r"\\f[BIR]", "", troff).replace("\\-", "-").replace("\\&", "").replace("\\(ga", "`")


class HelpText(unittest.TestCase):
    def test_options_are_read_with_value_choices_limits_and_relations(self):
        command, options = options_of(HELP)
        self.assertEqual(command.text, "What it does")
        self.assertEqual(command.footer, ["Look at the camera."])
        self.assertEqual(options["--help"].names, ["-h", "--help"])
        self.assertTrue(options["INPUT"].positional and options["INPUT"].required)
        self.assertEqual(options["WHERE"].notes, ["default /run/somewhere"])
        self.assertEqual(options["--model"].choices, ["attention", "mesh"])
        self.assertEqual(options["--model"].text, "attention: exact; mesh: lighter")
        self.assertEqual(options["--timeout"].notes, ["0.1 to 3600", "default 15"])
        self.assertEqual(options["--blend"].notes, ["needs --personal", "0 to 100"])
        self.assertTrue(options["--rigid"].repeats)
        self.assertEqual(options["--rigid"].notes, ["not with --model"])
        self.assertEqual(options["--fast"].value, "")

    def test_newer_ways_to_show_a_default_are_read(self):
        newer = HELP.replace("}=attention", "} [attention] ").replace("]=15", "] [15] ")
        self.assertEqual(options_of(newer)[1], options_of(HELP)[1])

    def test_a_description_over_several_lines_is_one(self):
        self.assertEqual(options_of(HELP)[1]["--out"].text, "The file to write; it is new, or written over")

    def test_a_declaration_that_nobody_foresaw_ends_the_build(self):
        with self.assertRaisesRegex(SystemExit, "left over: 'WORSE'"):
            options_of(HELP.replace("--fast       ", "--fast WORSE "))


class Pages(unittest.TestCase):
    def test_text_is_no_command_of_troff(self):
        self.assertEqual(pages.escape(".csv or \\n"), "\\&.csv or \\en")

    def test_keys_carry_their_defaults_and_comments(self):
        text = pages.keys('# head of the file\n\n[host]   # the line\nline = "a#b" # what\n   # goes on\n'
                          "# before it\nbaud = 9600\n")
        self.assertEqual(text, '.SS [host]\nthe line\n.TP\n\\fBline\\fR = "a#b"\nwhat goes on\n'
                               ".TP\n\\fBbaud\\fR = 9600\nbefore it")

    def test_every_option_of_every_command_is_in_its_page_and_in_each_completion(self):
        for program, page in (("facewire", "facewire.1"), ("facewired", "facewired.8")):
            texts = [unformatted((MADE / page).read_text())]
            texts += [(MADE / name).read_text() for name in (f"{program}.bash", f"_{program}")]
            for command in help_text.read([PROGRAMS[program]]):
                # Straight from the program, without the reader that made the pages.
                said = subprocess.run([PROGRAMS[program], *command.name.split(), "--help"], check=True,
                                      capture_output=True, text=True).stdout
                names = set(re.findall(r"^  (?:-\w, *)?(--[\w-]+)", said, re.MULTILINE))
                self.assertGreater(len(names), 0)
                for name in names | set(command.name.split()):
                    for text in texts:
                        self.assertIn(name, text)
                    self.assertIn(name.removeprefix("--"), (MADE / f"{program}.fish").read_text())

    def test_every_key_of_the_example_configuration_is_in_its_page(self):
        page = unformatted((MADE / "facewire.toml.5").read_text())
        example = (SOURCES / "app/share/facewire.toml").read_text()
        for key in re.findall(r"^([\w.]+) *=", example, re.MULTILINE):
            self.assertTrue(f"\n{key} = " in page, key)

    def test_every_key_that_rigs_may_have_is_in_their_page(self):
        page = (MADE / "facewire-rig.5").read_text()
        source = (SOURCES / "app/rig_file.cc").read_text()
        keys = set(re.findall(r'\.(?:Text|Number|Numbers|EachNumber|EachTable|Require|Integer|Points?)\(\s*"(\w+)"', source))
        self.assertGreater(len(keys), 10)
        for key in keys:
            self.assertRegex(page, rf"\b{key}\b")

    def test_the_pages_are_good_troff(self):
        for page in MADE.glob("*.[158]"):
            said = subprocess.run(["mandoc", "-Tlint", "-Wwarning", page], capture_output=True, text=True).stdout
            self.assertEqual(said, "")


class Completion(unittest.TestCase):
    def test_bash_takes_what_was_written(self):
        for program in PROGRAMS:
            subprocess.run(["bash", "-n", MADE / f"{program}.bash"], check=True)

    def test_quotes_in_descriptions_do_no_harm(self):
        command, _ = options_of(HELP.replace("No waiting", "The performer's own"))
        self.assertIn("-d 'The performer\\'s own'", completion.fish("program", [command]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
