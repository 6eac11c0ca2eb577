"""The viewer: pages, the server and the widget."""
