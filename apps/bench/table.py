#!/usr/bin/env python3
"""Prints results of mmbrdf-bench as a Markdown table: table.py FILE.json [PREFIX...]

Where the benchmarks were repeated, the median is shown."""
import json
import sys


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        results = json.load(file)["benchmarks"]
    if any(r.get("aggregate_name") == "median" for r in results):
        results = [r for r in results if r.get("aggregate_name") == "median"]
    prefixes = tuple(sys.argv[2:]) or ("",)
    print("| benchmark | ns | slots |")
    print("|---|---|---|")
    for r in results:
        name = r["run_name"].removesuffix("/real_time")
        if name.startswith(prefixes):
            ns, slots = next(value for key, value in r.items() if key.startswith("ns_per_")), r["slots"]
            print(f"| `{name}` | {ns:.{2 if ns < 100 else 0}f} | {slots:.{1 if slots < 1000 else 0}f} |")


if __name__ == "__main__":
    main()
