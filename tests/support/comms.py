"""The line between a widget and its page, without a notebook."""

import json


class Comm:
    """What a widget opens: keeps what is sent, and hands over what a page says."""

    def __init__(self, data=None, **_):
        self.comm_id, self.sent, self.opened = "1", [], data

    def on_msg(self, heard):
        self.heard = heard

    def send(self, data=None, **_):
        self.sent.append(data)

    def close(self, *_, **__):
        pass

    def says(self, **state):
        data = {"method": "update", "state": state, "buffer_paths": []}
        # As it comes through the line.
        self.heard({"content": {"data": json.loads(json.dumps(data))}, "buffers": []})

    @property
    def told(self):
        """The last values that were sent, by their names."""
        values = {}
        for message in self.sent:
            if message["method"] == "update":
                values |= message["state"]
        return values
