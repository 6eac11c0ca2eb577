declare module "virtual:polhode-core" {
  /** The compiled core, gzip in base64. */
  const packed: string;
  export default packed;
}

declare module "*?base64" {
  const content: string;
  export default content;
}
