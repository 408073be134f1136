# SPDX-License-Identifier: BSD-3-Clause
"""What is left when somebody ends the program, closes its output or leaves it little room: nothing is lost, nothing stays.

    tests/faults/signals.py PROGRAM
"""

import os
import pathlib
import pty
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
ROWS = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg\n"


class Ended(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        (self.folder / "out.csv").write_text("old\n")

    def start(self, stderr=subprocess.PIPE, output="out.csv", **more):
        """A process that has written some rows and waits for more."""
        words = [PROGRAM, "evaluate", "ptfe", "-g", "-", "-o", output]
        process = subprocess.Popen(words, cwd=self.folder, stdin=subprocess.PIPE, stderr=stderr, **more)
        self.addCleanup(lambda: (process.stdin.close(), process.stderr and process.stderr.close(), process.wait()))
        process.stdin.write((ROWS + "532,45,0,30,180\n" * 20000).encode())
        process.stdin.flush()
        for _ in range(200):
            if len(list(self.folder.iterdir())) == 2:
                return process
            time.sleep(0.05)
        self.fail("no temporary file")

    def test_by_a_signal_has_its_status_and_leaves_the_old_file_alone(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGABRT):
            with self.subTest(signal=number):
                process = self.start()
                process.send_signal(number)
                self.assertEqual(process.wait(20), -number)
                self.assertEqual([file.name for file in self.folder.iterdir()], ["out.csv"])
                self.assertEqual((self.folder / "out.csv").read_text(), "old\n")

    def test_not_by_a_signal_that_is_ignored(self):
        process = self.start(preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
        process.send_signal(signal.SIGINT)
        process.communicate()
        self.assertEqual(process.returncode, 0)
        self.assertEqual(len((self.folder / "out.csv").read_text().splitlines()), 20001)

    def test_by_a_signal_or_an_error_leaves_no_line_of_progress(self):
        for end in ("signal", "error"):
            with self.subTest(end):
                master, terminal = pty.openpty()
                process = self.start(stderr=terminal)
                os.close(terminal)
                said = b""
                while b"rows" not in said:  # until it counts
                    process.stdin.write(b"532,45,0,30,180\n" * 5000)
                    process.stdin.flush()
                    os.set_blocking(master, False)
                    try:
                        said += os.read(master, 4096)
                    except BlockingIOError:
                        time.sleep(0.05)
                if end == "signal":
                    process.terminate()
                else:
                    process.stdin.write(b"wrong\n")
                    process.stdin.close()
                process.wait(20)
                os.set_blocking(master, True)
                try:
                    while more := os.read(master, 4096):
                        said += more
                except OSError:  # the end of a terminal
                    pass
                os.close(master)
                rest = said[said.rindex(b"rows") + 4 :]
                self.assertTrue(rest.startswith(b"\r\x1b[K"), said)
                self.assertEqual(rest == b"\r\x1b[K", end == "signal")


class Told(unittest.TestCase):
    def run_in(self, folder, line, **more):
        return subprocess.run([PROGRAM, *line.split()], cwd=folder, capture_output=True, text=True, **more)

    def test_that_a_model_is_saved_though_its_table_cannot_be_printed(self):
        with tempfile.TemporaryDirectory() as folder:
            self.run_in(folder, "simulate ptfe --grid random:60 -w 532 -o data.csv").check_returncode()
            line = f"{PROGRAM} fit data.csv --orders 2,1 -o m.json >&-"
            result = subprocess.run(line, shell=True, cwd=folder, stderr=subprocess.PIPE, text=True)
            self.assertEqual(result.returncode, 1)
            self.assertIn("standard output: cannot write: Bad file descriptor; m.json is written\n", result.stderr)
            self.run_in(folder, "info m.json").check_returncode()

    def test_of_names_out_of_files_in_one_line_without_control_characters(self):
        with tempfile.TemporaryDirectory() as folder:
            self.run_in(folder, "convert ptfe-532 m.json").check_returncode()
            file = pathlib.Path(folder) / "m.json"
            text = file.read_text()
            file.write_text(text.replace('"name": "', '"name": "a\\n\\u001b[31m' + "x" * 9000, 1))
            printed = self.run_in(folder, "info m.json").stdout
            self.assertTrue(printed.startswith("name         a\\x0a\\x1b[31mxxx"), printed[:80])
            self.assertLess(len(printed.splitlines()[0]), 450)

    def test_nothing_where_many_threads_find_little_room(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "g.csv").write_text(ROWS + "532,45,0,30,180\n" * 60000)
            room = 100 << 20
            result = self.run_in(
                folder,
                "evaluate ptfe -g g.csv --threads 64 -o out.csv",
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (room, room)),
            )
            self.assertEqual((result.returncode, result.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
