#!/bin/sh
# Says what the viewer cannot be built without, if anything is missing. Rust's library for WebAssembly comes by rustup;
# where its server cannot be reached, any Rust that has the target will do. Debian's `rustc-web libstd-rust-web-dev
# rust-web-src lld` have it as sources: RUSTC_BOOTSTRAP=1 cargo build -Zbuild-std=std,panic_abort … makes the core.
node=$(node --version 2>/dev/null | sed 's/^v//; s/\..*//')
if [ "${node:-0}" -lt 20 ]; then
    echo "Node >= 20 was not found"
elif ! command -v npm >/dev/null; then
    echo "npm was not found"
elif ! [ -d "$(rustc --print target-libdir --target wasm32-unknown-unknown 2>/dev/null)" ]; then
    if ! command -v rustup >/dev/null; then
        echo "Rust for wasm32-unknown-unknown was not found, nor rustup to install it"
    elif ! rustup target add wasm32-unknown-unknown >/dev/null 2>&1; then
        echo "rustup could not install Rust for wasm32-unknown-unknown"
    fi
fi
