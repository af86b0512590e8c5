"""Validation cases from Python."""
import os
import tempfile
import unittest
from unittest import mock

import weft
from support import main
from weft import validation


class Validation(unittest.TestCase):
    def test_a_case(self):
        report = weft.validate("oscillator")
        self.assertTrue(report.passed)
        self.assertGreater(len(report.checks), 10)
        self.assertEqual(report.folder, "")

    def test_a_point_of_a_case_with_its_report(self):
        with tempfile.TemporaryDirectory() as folder:
            report = weft.validate("oscillator", parameters={"mass": 2, "time_step": 0.01}, output=folder)
            self.assertEqual(report.folder, folder)
            self.assertIn("index.html", os.listdir(folder))

    def test_what_is_refused(self):
        with self.assertRaisesRegex(ValueError, "osculator"):
            weft.validate("osculator")
        with self.assertRaisesRegex(ValueError, "quick=True and cases hang"):
            weft.validate("hang", quick=True)
        with self.assertRaisesRegex(ValueError, "height|--height"):
            weft.validate("oscillator", parameters={"height": 2})

    def test_the_command_is_found(self):
        given = os.environ["WEFT_COMMAND"]
        with mock.patch.dict(os.environ):
            del os.environ["WEFT_COMMAND"]
            self.assertTrue(os.path.samefile(validation.command(), given))
        with mock.patch.dict(os.environ, WEFT_COMMAND="/nowhere/weft"), self.assertRaisesRegex(weft.Error, "/nowhere/weft"):
            weft.validate("oscillator")


if __name__ == "__main__":
    main()
