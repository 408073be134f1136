declare module "virtual:wasm" {
  /** The WebAssembly module, compressed by gzip, in base 64. */
  const wasm: string;
  export default wasm;
}
declare module "*?worker&inline" {
  const Kind: new () => Worker;
  export default Kind;
}
declare module "*.css";
