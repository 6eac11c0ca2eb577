"""The viewer: pages, the server, the widget and captured pictures."""
