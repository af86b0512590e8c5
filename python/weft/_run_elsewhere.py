"""Runs a scene for Scene.run() in a process of its own, because a process has Bullet in one precision only: JSON in, JSON out."""
import json
import sys

from weft.errors import Error
from weft.scene import Scene


def main():
    request = json.load(sys.stdin)
    try:
        scene = Scene(request["load"]) if "load" in request else Scene.from_text(request["text"], request["name"])
        answer = scene._run(request["engine"], request["precision"], request["output"], request["replace"], request["duration"],
                            request["time_step"])
    except Error as error:
        answer = {"error": type(error).__name__, "message": str(error)}
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
