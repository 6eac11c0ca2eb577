const ICONS = {
  play: "M7 4.5v15l12.5-7.5z",
  pause: "M7 5h3.6v14H7zM13.4 5H17v14h-3.6z",
  restart: "M6 5h2.4v14H6zM19 5v14L9.5 12z",
  back: "M15.5 5v14L6 12zM17 5h2v14h-2z",
  forward: "M8.5 5v14L18 12zM5 5h2v14H5z",
  minus: "M5 11h14v2H5z",
  plus: "M11 5h2v6h6v2h-6v6h-2v-6H5v-2h6z",
  down: "M6 8.5h12L12 16z",
  right: "M9 6v12l7.5-6z",
  open: "M4 5h6l2 2h8v3H4zM4 11.5h16V19H4z",
  undo: "M12 6a7 7 0 1 1-6.6 9.3l1.9-.7A5 5 0 1 0 12 8H8.8l2.6 2.6L10 12 5 7l5-5 1.4 1.4L8.8 6z",
  redo: "M12 6a7 7 0 1 0 6.6 9.3l-1.9-.7A5 5 0 1 1 12 8h3.2l-2.6 2.6L14 12l5-5-5-5-1.4 1.4L15.2 6z",
  scenes: "M4 4h7v7H4zM13 4h7v7h-7zM4 13h7v7H4zM13 13h7v7h-7z",
  fit: "M3 3h6v2H5v4H3zM15 3h6v6h-2V5h-4zM19 15h2v6h-6v-2h4zM3 15h2v4h4v2H3z",
  share:
    "M17 15a3 3 0 0 0-2.2 1L9.9 13.1a3.2 3.2 0 0 0 0-2.2L14.8 8A3 3 0 1 0 14 6c0 .2 0 .5.1.7L9 9.8a3 3 0 1 0 0 4.4l5.1 3.1A3 3 0 1 0 17 15z",
  link: "M4 12a4 4 0 0 1 4-4h3v2H8a2 2 0 0 0 0 4h3v2H8a4 4 0 0 1-4-4zm5-1h6v2H9zm4-3h3a4 4 0 0 1 0 8h-3v-2h3a2 2 0 0 0 0-4h-3z",
  picture: "M4 5h16v14H4zm2 2v8l3.5-4 3 3.5 2-2 3.5 3.5V7zm9 1.2a1.5 1.5 0 1 1 0 3 1.5 1.5 0 0 1 0-3z",
  page: "M6 3h8l4 4v14H6zm2 2v14h8V8h-3V5z",
  close: "M6.4 5 12 10.6 17.6 5 19 6.4 13.4 12l5.6 5.6-1.4 1.4-5.6-5.6L6.4 19 5 17.6l5.6-5.6L5 6.4z",
};

export type IconName = keyof typeof ICONS;

/** A decorative icon; the label of its button says what the button does. */
export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true">
      <path d={ICONS[name]} />
    </svg>
  );
}

/** A button with an icon. Its tooltip is the label, with the key that does the same. */
export function IconButton(props: {
  id: string;
  label: string;
  icon: IconName;
  press?: string;
  class?: string;
  onClick: () => void;
}) {
  const { id, label, icon, press, onClick } = props;
  return (
    <button
      id={id}
      class={props.class}
      aria-label={label}
      title={press ? `${label} (${press})` : label}
      onClick={onClick}
    >
      <Icon name={icon} />
    </button>
  );
}
