# SPDX-License-Identifier: BSD-3-Clause
"""Commands that are killed at any moment, find a full disc, write what others write, or read what others replace.

An output is the old one or a new one, whole; a command that fails says why in one line and leaves nothing behind.

    tests/faults/disturbed.py PROGRAM
"""

import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
OLD = b"old\n"
COMMANDS = {  # what is asked, and what it writes
    "evaluate": ("evaluate model.json -g rows.csv -o out.csv", ["out.csv"]),
    "fit": ("fit data.csv --orders 2,1 -o out.json", ["out.json"]),
    "simulate": ("simulate model.json --grid random:5000 -o out.csv", ["out.csv"]),
    "simulate --raw": ("simulate model.json --grid random:40 --raw out", ["out/references.csv", "out/raw.csv"]),
    "report": ("report model.json data.csv -o out.json", ["out.json"]),
}


def run(line, folder, **more):
    return subprocess.run([PROGRAM, *line.split()], cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, **more)


class Disturbed(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        for line in (
            "simulate ptfe --grid random:60 -w 532 --noise speckle:0.01 -o data.csv",
            "simulate ptfe --grid random:6000 -w 532 -o rows.csv",
            "convert ptfe-532 model.json",
        ):
            run(line, self.folder).check_returncode()

    def put_old(self, folder, outputs):
        for output in outputs:
            (folder / output).parent.mkdir(exist_ok=True)
            (folder / output).write_bytes(OLD)

    def contents(self, folder, outputs):
        return [(folder / output).read_bytes() for output in outputs]

    def new(self, line, outputs):
        """What the command writes, and the seconds that it takes."""
        self.put_old(self.folder, outputs)
        begin = time.monotonic()
        run(line, self.folder).check_returncode()
        return self.contents(self.folder, outputs), time.monotonic() - begin

    def leftovers(self, before):
        return {path for path in self.folder.rglob("*") if path.is_file()} - before

    def test_by_a_kill_at_any_moment_leave_the_old_or_the_new(self):
        chance = random.Random(1)
        for name, (line, outputs) in COMMANDS.items():
            new, seconds = self.new(line, outputs)
            before = self.leftovers(set())
            for number in [signal.SIGKILL, signal.SIGTERM] * 4:
                self.put_old(self.folder, outputs)
                process = subprocess.Popen(
                    [PROGRAM, *line.split()], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
                )
                time.sleep(chance.uniform(0, 1.2 * seconds))
                process.send_signal(number)
                status = process.wait(20)
                with self.subTest(name, number=number, status=status):
                    self.assertIn(status, (0, -number))
                    self.assertIn(self.contents(self.folder, outputs), [new] if status == 0 else [new, [OLD] * len(new)])
                    left = self.leftovers(before)
                    if number == signal.SIGTERM:
                        self.assertEqual(left, set())
                    self.assertTrue(all(path.name.startswith(".mmbrdf-") for path in left), left)
                    for path in left:
                        path.unlink()

    def test_by_a_full_disc_leave_the_old_and_say_so(self):
        """On a disc of so few bytes in memory, where the system lets everybody mount one."""
        disc = self.folder / "disc"
        disc.mkdir()
        for name, (line, outputs) in COMMANDS.items():
            size = sum(map(len, self.new(line, outputs)[0]))
            for pages in {1 + len(outputs), max(1 + len(outputs), size // 2 // os.sysconf("SC_PAGE_SIZE"))}:
                words = [str(self.folder / word) if word.endswith((".csv", ".json")) else word for word in line.split()]
                words[words.index("--raw" if "--raw" in words else "-o") + 1] = outputs[0].split("/")[0]
                script = f"""
                    mount -t tmpfs -o size={pages * os.sysconf("SC_PAGE_SIZE")} none {disc} || exit 77
                    cd {disc} && mkdir -p out && printf 'old\\n' | tee {' '.join(outputs)} > /dev/null
                    {PROGRAM} {' '.join(words)} > /dev/null; echo $?
                    cat {' '.join(outputs)}; find . -name '.mmbrdf-*'"""
                result = subprocess.run(
                    ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script], capture_output=True, text=True
                )
                if result.returncode != 0:
                    self.skipTest(f"no disc of one's own can be mounted here: {result.stderr.strip()}")
                with self.subTest(name, pages=pages):
                    self.assertEqual(result.stdout, "1\n" + "old\n" * len(outputs))
                    said = [line for line in result.stderr.splitlines() if "warning:" not in line and "note:" not in line]
                    self.assertEqual(len(said), 1, said)
                    self.assertRegex(said[0], "^mmbrdf: .*: cannot (write|be written): No space left on device$")

    def test_by_another_writer_of_the_same_file_leave_one_of_both(self):
        for name in ("simulate", "simulate --raw"):
            lines = [COMMANDS[name][0] + f" --seed {seed}" for seed in (1, 2)]
            outputs = COMMANDS[name][1]
            new = [self.new(line, outputs)[0] for line in lines]
            before = self.leftovers(set())
            for _ in range(20):
                self.put_old(self.folder, outputs)
                both = [
                    subprocess.Popen([PROGRAM, *line.split()], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    for line in lines
                ]
                with self.subTest(name):
                    self.assertEqual([process.wait(20) for process in both], [0, 0])
                    for found, *either in zip(self.contents(self.folder, outputs), *new):
                        self.assertIn(found, either)
                    self.assertEqual(self.leftovers(before), set())

    def test_by_an_input_that_is_replaced_answer_of_one_of_both(self):
        inputs = {"model.json": [], "data.csv": []}
        for seed in (1, 2):
            run(f"simulate ptfe-532 --grid random:60 --noise speckle:0.01 --seed {seed} -o new.csv", self.folder)
            inputs["data.csv"].append((self.folder / "new.csv").read_bytes())
            run("fit new.csv --orders 2,1 --uncertainty noise -o new.json", self.folder).check_returncode()
            inputs["model.json"].append((self.folder / "new.json").read_bytes())

        def put(name, version):
            (self.folder / "next").write_bytes(inputs[name][version])
            (self.folder / "next").replace(self.folder / name)

        for line, name in (
            ("report model.json data.csv", "data.csv"),
            ("report model.json data.csv", "model.json"),
            ("compare model.json data.csv", "model.json"),
            ("analyze model.json -i 45,0 -r 30,180", "model.json"),
            ("fit data.csv --orders 1,1 -o fitted.json", "data.csv"),
        ):
            for one in inputs:
                put(one, 0)
            answers = []
            for version in (1, 0):
                put(name, version)
                answers.append(run(line, self.folder).stdout)
            for turn in range(4):
                process = subprocess.Popen(
                    [PROGRAM, *line.split()], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
                )
                version = turn
                while process.poll() is None:
                    version += 1
                    put(name, version % 2)
                with self.subTest(line, replaced=name):
                    self.assertEqual(process.returncode, 0)
                    self.assertIn(process.stdout.read(), answers)
                process.stdout.close()

    def test_by_an_input_that_is_cut_meanwhile_say_so_or_have_read_it(self):
        """In place, in the middle of a row: what nobody should do to a file."""
        rows = (self.folder / "rows.csv").read_bytes()
        whole, seconds = self.new("evaluate model.json -g rows.csv -o out.csv", ["out.csv"])
        chance = random.Random(2)
        for _ in range(8):
            (self.folder / "rows.csv").write_bytes(rows)
            self.put_old(self.folder, ["out.csv"])
            process = subprocess.Popen(
                [PROGRAM, *"evaluate model.json -g rows.csv -o out.csv".split()], cwd=self.folder, stderr=subprocess.PIPE
            )
            time.sleep(chance.uniform(0, seconds))
            os.truncate(self.folder / "rows.csv", len(rows) // 2 - chance.randrange(3))
            said = process.communicate()[1].decode()
            with self.subTest(status=process.returncode, said=said):
                if process.returncode == 0:
                    self.assertTrue(whole[0].startswith((self.folder / "out.csv").read_bytes()[:-400]))
                else:
                    self.assertEqual((self.folder / "out.csv").read_bytes(), OLD)
                    self.assertEqual(len([line for line in said.splitlines() if "warning:" not in line]), 1)


if __name__ == "__main__":
    unittest.main()
