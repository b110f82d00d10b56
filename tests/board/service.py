"""The service on the board, as its administrator sees it."""
import json

from machine import wait_until

CONFIG = "/etc/facewire/facewire.toml"


class Service:
    def __init__(self, agent):
        self._agent = agent

    def property(self, name):
        return self._agent.read(f"systemctl show facewired --property={name} --value")

    def pid(self):
        return int(self.property("MainPID"))

    def started_s(self):
        """When its process began, on the clock of its poses."""
        return int(self.property("ExecMainStartTimestampMonotonic")) / 1e6

    def restarts(self):
        return int(self.property("NRestarts"))

    def do(self, verb, timeout=180):
        """systemctl VERB."""
        return self._agent.read(f"systemctl {verb} facewired", timeout)

    def memory(self):
        """(resident MiB, threads)."""
        status = self._agent.read(f"cat /proc/{self.pid()}/status")
        fields = dict(line.split(":", 1) for line in status.splitlines())
        return int(fields["VmRSS"].split()[0]) / 1024, int(fields["Threads"])

    def journal_mark(self):
        """A place in the journal; what follows it is new."""
        return self._agent.read("journalctl --unit=facewired --lines=0 --show-cursor | sed -n 's/^-- cursor: //p'")

    def journal(self, mark=None):
        """What the service, and systemd about it, said since; without a mark, since the board is on."""
        after = f"--after-cursor='{mark}'" if mark else ""
        out = self._agent.read(f"journalctl --unit=facewired --output=json {after}")
        lines = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
        return "\n".join(str(line["MESSAGE"]) for line in lines)

    def wait_for_words(self, words, timeout, mark=None):
        """Until the journal holds `words`; all that it said since."""
        wait_until(f"the journal to say '{words}'", lambda: words in self.journal(mark), timeout)
        return self.journal(mark)
