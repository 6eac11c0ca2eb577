const PATHS = {
  play: "M7 4.5v15l12.5-7.5z",
  pause: "M7 5h3.6v14H7zM13.4 5H17v14h-3.6z",
  restart: "M6 5h2.4v14H6zM19 5v14L9.5 12z",
  back: "M15.5 5v14L6 12zM17 5h2v14h-2z",
  forward: "M8.5 5v14L18 12zM5 5h2v14H5z",
  minus: "M5 11h14v2H5z",
  plus: "M11 5h2v6h6v2h-6v6h-2v-6H5v-2h6z",
  open: "M4 5h6l2 2h8v3H4zM4 11.5h16V19H4z",
  light: "M12 3a9 9 0 1 0 0 18zm0 2v14a7 7 0 0 1 0-14z M12 3a9 9 0 0 1 0 18v-2a7 7 0 0 0 0-14z",
  close: "M6.4 5 12 10.6 17.6 5 19 6.4 13.4 12l5.6 5.6-1.4 1.4-5.6-5.6L6.4 19 5 17.6l5.6-5.6L5 6.4z",
};

/** A sign on a button, whose label says what it does. */
export function Icon({ name }: { name: keyof typeof PATHS }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true">
      <path d={PATHS[name]} />
    </svg>
  );
}
