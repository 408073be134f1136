// SPDX-License-Identifier: BSD-3-Clause
// What is in index.html.

export const element = <T extends HTMLElement = HTMLElement>(id: string) => document.getElementById(id) as T;

export const field = (id: string) => element<HTMLInputElement>(id);
export const choice = (id: string) => element<HTMLSelectElement>(id);
