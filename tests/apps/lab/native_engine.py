# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Serves the lab page with the C++ engine as a program instead of WebAssembly, on a local port."""

import contextlib
import http.server
import json
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

HERE = Path(__file__).resolve().parent
PACK = HERE.parents[2] / "viewer" / "pack.py"
LAB = HERE.parents[2] / "apps" / "lab" / "page" / "index.html"


def handler_of(program):
    """Answers each new request with a separate process and forwards its lines immediately."""
    # Complete answers, as every fresh page sends the same requests first. Not of designs, because
    # tests cancel them.
    answers = {}

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_POST(self):
            request = self.rfile.read(int(self.headers["Content-Length"]))
            self.send_response(200)
            self.send_header("Access-Control-Allow-Origin", "*")
            self.end_headers()
            if request in answers:
                return self.wfile.write(answers[request])
            with subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as engine:
                engine.stdin.write(request)
                engine.stdin.close()
                answer = b""
                try:
                    for line in engine.stdout:
                        self.wfile.write(line)
                        answer += line
                    if engine.wait() == 0 and json.loads(request)["call"] != "design":
                        answers[request] = answer
                except OSError:  # the page has ended its worker
                    engine.kill()

        def log_message(self, *_):
            pass

    return Handler


@contextlib.contextmanager
def page_with_engine(program):
    """Yields the path of a page whose workers send requests to the program."""
    with tempfile.TemporaryDirectory(prefix="tofsmith-lab-") as folder:
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler_of(program))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        worker, page = Path(folder, "worker.js"), Path(folder, "lab.html")
        address = f"http://127.0.0.1:{server.server_port}/"
        worker.write_text((HERE / "native_worker.js").read_text().replace("ENGINE_ADDRESS", f"'{address}'"))
        subprocess.run([sys.executable, PACK, "--page", LAB, "--worker", worker, "-o", page], check=True)
        text = page.read_text()
        for before, after in (("default-src 'none';", f"default-src 'none'; connect-src {address};"),
                              ("trials: 20000,", "trials: 100,")):  # less to compute in each test
            if before not in text:
                raise ValueError(f"{page} has no {before}")
            text = text.replace(before, after, 1)
        page.write_text(text)
        yield page
        server.shutdown()
