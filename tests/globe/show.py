"""Opens a folder of terrain tiles in CesiumJS, in a Chromium without a window, and keeps a picture.

    npm install --ignore-scripts cesium
    python3 tests/globe/show.py TILES PICTURE.png --cesium node_modules/cesium/Build/Cesium

Fails if CesiumJS reports an error, or asks for a file that is not there. It is not part of .ci/run: it needs a browser.
"""

import argparse
import base64
import http.server
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).parent


def view_of(tiles):
    """Return west, south, east and north in degrees with a height to look at, and the format of the tiles."""
    layer = tiles / "layer.json"
    if layer.exists():
        return [*json.loads(layer.read_text())["bounds"], 0.0], "terrain"
    root = json.loads((tiles / "tileset.json").read_text())["root"]
    *region, low, high = root["boundingVolume"]["region"]
    return [*map(math.degrees, region), (low + high) / 2], "3dtiles"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tiles", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--cesium", type=pathlib.Path, required=True, help="Build/Cesium of the npm package")
    parser.add_argument("--chromium", default="chromium")
    parser.add_argument("--height", type=float, help="height to look at")
    parser.add_argument("--view", help="west,south,east,north in degrees")
    options = parser.parse_args()
    view, kind = view_of(options.tiles)
    if options.view:
        view[:4] = map(float, options.view.split(","))
    if options.height is not None:
        view[4] = options.height
    done = threading.Event()
    result = {"errors": [], "missing": [], "served": 0}

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            path = self.path.split("?")[0]
            if path == "/page":
                file, folder = HERE / "page.html", HERE
            elif path.startswith("/cesium/"):
                folder = options.cesium
                file = folder / path[len("/cesium/"):]
            else:
                folder = options.tiles
                file = folder / path[len("/tiles/"):]
            if not file.is_file() or folder.resolve() not in file.resolve().parents:
                if path.startswith("/tiles/"):
                    result["missing"].append(path)
                self.send_error(404)
                return
            body = file.read_bytes()
            self.send_response(200)
            types = {".html": "text/html", ".js": "text/javascript", ".json": "application/json", ".css": "text/css"}
            self.send_header("Content-Type", types.get(file.suffix, "application/octet-stream"))
            if folder == options.tiles:
                result["served"] += 1
                if body[:2] == b"\x1f\x8b":
                    self.send_header("Content-Encoding", "gzip")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def do_POST(self):
            body = self.rfile.read(int(self.headers["Content-Length"]))
            if self.path == "/picture":
                options.picture.write_bytes(base64.b64decode(body))
            else:
                result.update(json.loads(body))
                done.set()
            self.send_response(204)
            self.end_headers()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    words = ",".join(map(str, view))
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = subprocess.Popen(
            [
                options.chromium, "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                "--ignore-gpu-blocklist", f"--user-data-dir={profile}", "--window-size=1200,800",
                f"http://127.0.0.1:{server.server_port}/page?view={words}&format={kind}",
            ],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        try:
            if not done.wait(240):
                result["errors"].append("the page did not answer within 240 s")
        finally:
            browser.kill()
            browser.wait()
    print(json.dumps(result, indent=1))
    return 1 if result["errors"] or result["missing"] or not options.picture.exists() else 0


if __name__ == "__main__":
    sys.exit(main())
