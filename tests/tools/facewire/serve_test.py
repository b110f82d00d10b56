#!/usr/bin/env python3
"""`facewire serve` between a pseudo-terminal and a web client made of Python's library: serve_test.py FACEWIRE"""
import base64
import hashlib
import os
import pathlib
import select
import signal
import socket
import subprocess
import sys
import tempfile
import tty
import unittest
import urllib.error
import urllib.request

FACEWIRE = sys.argv.pop(1)
PATIENCE_S = 60  # a busy machine, an emulated processor


class WebSocket:
    """Small frames, no fragments: what the server sends here."""

    def __init__(self, port, path="/line", origin=None):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
        key = base64.b64encode(bytes(range(16))).decode()
        lines = [f"GET {path} HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade",
                 f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        if origin:
            lines.append(f"Origin: {origin}")
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.rest = b""
        answer = b""
        while b"\r\n\r\n" not in answer:
            more = self.socket.recv(4096)
            if not more:
                break
            answer += more
        head, _, self.rest = answer.partition(b"\r\n\r\n")
        accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest())
        self.accepted = head.startswith(b"HTTP/1.1 101") and accept in head

    def take(self, size):
        while len(self.rest) < size:
            more = self.socket.recv(65536)
            if not more:
                raise EOFError
            self.rest += more
        taken, self.rest = self.rest[:size], self.rest[size:]
        return taken

    def receive(self, size):
        """At least so many bytes of binary messages."""
        data = b""
        while len(data) < size:
            first, length = self.take(2)
            assert first == 0x82, hex(first)  # final, binary
            if length == 126:
                length = int.from_bytes(self.take(2), "big")
            elif length == 127:
                length = int.from_bytes(self.take(8), "big")
            data += self.take(length)
        return data

    def send(self, data):
        assert len(data) < 126
        mask = b"\1\2\3\4"
        masked = bytes(b ^ mask[i % 4] for i, b in enumerate(data))
        self.socket.sendall(bytes([0x82, 0x80 | len(data)]) + mask + masked)


class Serve(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        page = pathlib.Path(self.folder.name) / "page"
        page.mkdir()
        self.page = str(page)
        (page / "index.html").write_text("<p>a page</p>")
        (page / "page.js").write_text("x" * 300_000)
        self.link = pathlib.Path(self.folder.name) / "line"
        self.make_line()
        self.process = subprocess.Popen([FACEWIRE, "serve", str(self.link), "--web-port", "0", "--page", str(page)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        address = self.process.stdout.readline()
        self.assertTrue(address.startswith("http://127.0.0.1:"), address)
        self.port = int(address.rstrip("/\n").rsplit(":", 1)[1])

    def tearDown(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=PATIENCE_S)
        self.assertEqual(self.process.returncode, 0)
        os.close(self.line)
        os.close(self.slave)
        self.folder.cleanup()

    def viewer(self, **how):
        viewer = WebSocket(self.port, **how)
        self.addCleanup(viewer.socket.close)
        return viewer

    def make_line(self):
        self.line, slave = os.openpty()
        tty.setraw(slave)
        self.link.unlink(missing_ok=True)
        self.link.symlink_to(os.ttyname(slave))
        self.slave = slave

    def get(self, path):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}{path}", timeout=PATIENCE_S) as answer:
            return answer.read()

    def read_line(self, size):
        data = b""
        while len(data) < size:
            self.assertTrue(select.select([self.line], [], [], PATIENCE_S)[0], "nothing came over the line")
            data += os.read(self.line, 4096)
        return data

    def test_it_serves_the_page(self):
        self.assertEqual(self.get("/"), b"<p>a page</p>")
        self.assertEqual(len(self.get("/page.js")), 300_000)
        for path in ["/nothing", "/../line"]:
            with self.assertRaises(urllib.error.HTTPError) as refused:
                self.get(path)
            refused.exception.close()

    def test_the_page_runs_nothing_of_other_servers(self):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/", timeout=PATIENCE_S) as answer:
            policy = answer.headers["content-security-policy"]
            self.assertEqual(answer.headers["x-content-type-options"], "nosniff")
        for part in ["default-src 'none'", "script-src 'self' 'wasm-unsafe-eval'", "frame-ancestors 'none'"]:
            self.assertIn(part, policy.split("; "))

    def test_bytes_of_the_line_come_to_every_viewer(self):
        viewers = [self.viewer(), self.viewer(origin=f"http://127.0.0.1:{self.port}")]
        for viewer in viewers:
            self.assertTrue(viewer.accepted)
        data = bytes(range(256)) * 8
        # Until it has taken notice of both, a viewer may miss what came before it.
        for viewer in viewers:
            viewer.send(b"here")
        self.read_line(8)
        os.write(self.line, data)
        for viewer in viewers:
            self.assertEqual(viewer.receive(len(data)), data)

    def test_what_a_viewer_sends_goes_to_the_line(self):
        viewer = self.viewer()
        viewer.send(bytes([0, 3, 1, 0x80, 0]))
        self.assertEqual(self.read_line(5), bytes([0, 3, 1, 0x80, 0]))

    def test_a_page_of_another_server_and_another_path_are_refused(self):
        self.assertFalse(self.viewer(origin="http://elsewhere.example").accepted)
        self.assertFalse(self.viewer(path="/other").accepted)
        self.assertTrue(self.viewer().accepted)

    def test_a_line_that_went_is_taken_up_again(self):
        viewer = self.viewer()
        viewer.send(b"here")
        self.read_line(4)
        os.close(self.slave)
        os.close(self.line)
        self.make_line()
        while "is back" not in self.process.stderr.readline():
            pass
        os.write(self.line, b"again")
        self.assertEqual(viewer.receive(5), b"again")

    def refused(self, *arguments):
        """Exit code and the one line of a second server, which has to end by itself."""
        second = subprocess.run([FACEWIRE, "serve", *arguments], capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(second.stdout, "")
        self.assertEqual(second.stderr.count("\n"), 1, second.stderr)
        return second.returncode, second.stderr

    def test_a_port_that_is_taken_is_said_in_one_line(self):
        code, said = self.refused(str(self.link), "--page", self.page, "--web-port", str(self.port))
        self.assertEqual(code, 1)
        self.assertIn(f"port {self.port} of 127.0.0.1 is taken; --web-port 0", said)

    def test_an_address_of_nobody_or_of_another_machine_is_refused(self):
        for address in ("300.1.1.1", "::1", "nobody.invalid", "", "192.0.2.1"):  # the last is for documentation alone
            code, said = self.refused(str(self.link), "--page", self.page, "--web-port", "0", "--address", address)
            self.assertEqual(code, 2)
            self.assertIn(f"--address {address}" if address == "192.0.2.1" else f"--address '{address}'", said)

    def test_a_folder_without_a_page_and_what_is_no_line_are_refused(self):
        for arguments, why in (((str(self.link), "--page", self.folder.name), "has no index.html"),
                               ((f"{self.page}/index.html", "--page", self.page), "is not a serial line"),
                               (("/dev/nobody", "--page", self.page), "there is no port /dev/nobody"),
                               ((str(self.link), "--web-port", "70000"), "not in range"),
                               ((), "PORT is required; ")):
            code, said = self.refused(*arguments)
            self.assertEqual(code, 2)
            self.assertIn(why, said)


if __name__ == "__main__":
    unittest.main()
