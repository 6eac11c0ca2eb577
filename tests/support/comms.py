"""A comm between a widget and its page, without a notebook."""

import json


class Comm:
    """A comm that records sent messages and passes on those of a page."""

    def __init__(self, data=None, **_):
        self.comm_id, self.sent, self.opened = "1", [], data

    def on_msg(self, callback):
        self.callback = callback

    def send(self, data=None, **_):
        self.sent.append(data)

    def close(self, *_, **__):
        pass

    def sends(self, **state):
        data = {"method": "update", "state": state, "buffer_paths": []}
        # As after transport.
        self.callback({"content": {"data": json.loads(json.dumps(data))}, "buffers": []})

    @property
    def received(self):
        """The last sent values, by name."""
        values = {}
        for message in self.sent:
            if message["method"] == "update":
                values |= message["state"]
        return values
