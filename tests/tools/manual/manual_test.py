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

    def test_every_verb_has_a_section_with_its_own_options(self):
        sections = re.split(r"^\.SS ", (MADE / "facewire.1").read_text(), flags=re.MULTILINE)
        sections = {name: unformatted(text) for name, _, text in (s.partition("\n") for s in sections)}
        verbs = [command for command in help_text.read([PROGRAMS["facewire"]]) if " " in command.name]
        self.assertGreater(len(verbs), 8)
        for verb in verbs:
            section = sections[verb.name]
            self.assertIn(f"facewire {verb.name} ", section)
            for option in verb.options:
                if "--help" not in option.names:
                    self.assertIn(f"\n.TP\n{', '.join(option.names)}", section)
                    self.assertIn(option.text, section)
            # What its command says of all of them is said once.
            group = verb.name.split()[0]
            for line in help_text.read([PROGRAMS["facewire"], group])[0].footer:
                self.assertNotIn(line, section)

    def test_a_sentence_over_several_lines_is_one_paragraph(self):
        command = help_text.Command("go", "Goes", footer=["It goes on and", "on. And", "ends.", "  And ends."])
        self.assertIn(".PP\nIt goes on and on. And ends.\n.PP\nAnd ends.", pages.commands([command]))

    def test_a_usage_line_has_what_has_to_be_there(self):
        page = unformatted((MADE / "facewire.1").read_text())
        self.assertIn("\nfacewire rig VERB\n", page)
        self.assertIn("\nfacewire rig import --out text [OPTIONS] CHARACTER\n", page)

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


    def test_a_program_may_need_an_emulator_with_options(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-B", SOURCES / "tools/manual/manual.py", "--version", "1", "--date",
                            "2020-01-01", "--config", SOURCES / "app/share/facewire.toml", "--out", folder,
                            "--facewire", f"'env' '-u' 'NOTHING' {PROGRAMS['facewire']}",
                            "--facewired", f"'env' '-u' 'NOTHING' {PROGRAMS['facewired']}"], check=True)
            self.assertTrue((pathlib.Path(folder) / "facewire.1").is_file())


class Completion(unittest.TestCase):
    def test_bash_takes_what_was_written(self):
        for program in PROGRAMS:
            subprocess.run(["bash", "-n", MADE / f"{program}.bash"], check=True)

    def completed(self, *words):
        """What bash offers for the last word, where the folder is empty."""
        script = (f"shopt -s progcomp; source {MADE / 'facewire.bash'}; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); "
                  "_facewire 2>/dev/null; printf '%s\\n' \"${COMPREPLY[@]}\"")
        with tempfile.TemporaryDirectory() as folder:
            said = subprocess.run(["bash", "-c", script, "bash", "facewire", *words], check=True, capture_output=True,
                                  text=True, cwd=folder)
        return said.stdout.split()

    def test_bash_knows_verbs_and_the_options_of_each(self):
        self.assertIn("import", self.completed("rig", ""))
        self.assertEqual(self.completed("rig", "sh"), ["show"])
        self.assertEqual(self.completed("rig", "import", "--u"), ["--unit"])
        self.assertEqual(self.completed("rig", "import", "head.glb", "--unit", "c"), ["cm"])
        self.assertEqual(self.completed("rig", "check", "--u"), [])
        self.assertEqual(self.completed("rig", "check", "--p"), ["--profile"])
        for verb in ("find", "list", "jog", "move", "limits", "set", "reboot", "wizard"):
            self.assertIn(verb, self.completed("servo", ""))
            self.assertIn("--help", self.completed("servo", verb, "--"))

    def test_quotes_in_descriptions_do_no_harm(self):
        command, _ = options_of(HELP.replace("No waiting", "The performer's own"))
        self.assertIn("-d 'The performer\\'s own'", completion.fish("program", [command]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
