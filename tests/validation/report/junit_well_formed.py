"""junit_well_formed.py JUNIT_XML REPORT_JSON: an XML parser reads the file, and its counts are those of the data."""
import json
import sys
import xml.etree.ElementTree as ElementTree

root = ElementTree.parse(sys.argv[1]).getroot()
with open(sys.argv[2], encoding="utf-8") as file:
    report = json.load(file)
cases = list(root.iter("testcase"))
checks = report["checks"]
expected = len(checks) + sum(len(check["sabotages"]) for check in checks)
assert root.tag == "testsuites", root.tag
assert len(cases) == expected, (len(cases), expected)
assert int(root.get("tests")) == expected
assert int(root.get("failures")) == len(list(root.iter("failure")))
assert len(list(root.iter("skipped"))) == report["summary"]["checks_not_gated"]
hostile = [failure for failure in root.iter("failure") if "</script>" in failure.get("message")]
assert hostile, "text with markup must survive as text"
print(f"{expected} test cases")
