#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""How well rank 0 of a sweep keeps many ranks busy: a simulation event by event.

    scheduler_simulation.py STORE.sqlite [--svg docs/images/scaling.svg] [--seed 1]

Item times are drawn from those that a real sweep left in STORE, stretched to the mean asked for.
The rules are those of src/sweep/run_sweep.cpp: a rank is short of work when at most half a batch is
left to it; a batch is as many items as take `batch_s` at the rank's own pace, at most 256 and at
most the 2 n-th part of what is left; results are sent 0.1 s after one another or when a rank has
nothing to do. Rank 0 does one thing at a time: it takes all messages that are there, stores their
results in one transaction, claims and sends. Its costs (see COSTS) were measured, see
docs/scaling.md; the network adds a delay to every message.
"""

import argparse
import heapq
import itertools
import random
import sqlite3

COSTS = {
    "claim_item_s": 42e-6,     # find and update of one item
    "finish_item_s": 188e-6,   # unpacking 86 us, update of one item and checksum 102 us
    "commit_s": 370e-6,        # one transaction
    "message_s": 20e-6,        # take or send one (assumed)
    "network_s": 50e-6,        # on its way
    "poll_s": 1e-3,            # rank 0 and the others look for messages once in
}
GATHERING_S, BATCH_MOST = 0.1, 256


def item_times(path, mean_s, count, rng):
    """Times of a real sweep, stretched to a mean."""
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as store:
        times = [t for (t,) in store.execute("SELECT seconds FROM items WHERE status = 'finished'")]
    scale = mean_s / (sum(times) / len(times))
    return [rng.choice(times) * scale for _ in range(count)]


class Rank:
    """One that computes: what it was given, when it is free, what it has to send."""

    def __init__(self):
        self.given = self.done = 0   # as rank 0 sees it
        self.free_at = self.busy_since = self.sent_at = self.busy_s = 0.0
        self.ready = []              # ends of items that were not sent yet


def simulate(times, ranks, batch_s, costs):
    """Efficiency: computing time over ranks times wall time."""
    crew = [Rank() for _ in range(ranks)]
    arrivals = []                    # (time, rank, items) on their way to rank 0
    left, now, total = len(times), 0.0, len(times)
    stored, next_item = 0, 0
    order = itertools.count()        # of messages that come at the same moment
    looked_at = crew                 # who may be short of work

    def batch_of(rank):
        each = (now - rank.busy_since) / rank.done if rank.done else 1e6
        return max(1, min(BATCH_MOST, int(batch_s / max(each, 1e-6)), left // (2 * ranks)))

    def give(rank, count):
        """It computes them one after another; results leave together."""
        nonlocal next_item, left
        begin = max(rank.free_at, now + costs["network_s"] + costs["poll_s"] / 2)
        if rank.given == 0:
            rank.busy_since, rank.done = now, 0
        pending, sent_at = 0, rank.sent_at
        for i in range(next_item, next_item + count):
            begin += times[i]
            rank.busy_s += times[i]
            pending += 1
            if begin - sent_at > GATHERING_S or i == next_item + count - 1:
                heapq.heappush(arrivals, (begin + costs["network_s"], next(order), rank, pending))
                pending, sent_at = 0, begin
        rank.free_at, rank.sent_at = begin, sent_at
        rank.given += count
        next_item += count
        left -= count

    while stored < total:
        # Takes what is there, stores it in one transaction.
        came, delivered = 0, {}
        while arrivals and arrivals[0][0] <= now:
            _, _, rank, items = heapq.heappop(arrivals)
            rank.given -= items
            rank.done += items
            came += items
            delivered[id(rank)] = rank
            now += costs["message_s"]
        if came:
            now += costs["commit_s"] + came * costs["finish_item_s"]
            stored += came
        # Claims for all who are short of work, in one transaction, and sends.
        gave = 0
        for rank in looked_at if looked_at is crew else delivered.values():
            if left == 0:
                break
            batch = batch_of(rank)
            if rank.given <= batch // 2:
                give(rank, min(batch, left))
                now += costs["message_s"] + batch * costs["claim_item_s"]
                gave += 1
        looked_at = None
        if gave:
            now += costs["commit_s"]
        if not came and not gave:
            soon = arrivals[0][0] if arrivals else now
            now = max(now + costs["poll_s"], soon)
    return sum(rank.busy_s for rank in crew) / (ranks * now)


def svg(path, counts, curves):
    """Efficiency over the number of ranks, one curve for each mean item time."""
    width, height, left, top, right, bottom = 560, 330, 55, 15, 130, 45
    colours = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e"]

    def place(i, efficiency):
        x = left + i * (width - left - right) / (len(counts) - 1)
        return x, top + (1 - efficiency) * (height - top - bottom)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
             'font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="white"/>']
    for tick in range(0, 101, 20):
        (x0, y), (x1, _) = place(0, tick / 100), place(len(counts) - 1, tick / 100)
        parts.append(f'<path d="M{x0:.0f} {y:.1f}H{x1:.0f}" stroke="#ddd"/>'
                     f'<text x="{x0 - 6:.0f}" y="{y + 4:.1f}" text-anchor="end">{tick} %</text>')
    for i, count in enumerate(counts):
        x, y = place(i, 0)
        parts.append(f'<text x="{x:.1f}" y="{y + 18:.1f}" text-anchor="middle">{count}</text>')
    for colour, (name, efficiencies) in zip(colours, curves.items()):
        points = " ".join("{:.1f},{:.1f}".format(*place(i, e)) for i, e in enumerate(efficiencies))
        x, y = place(len(counts) - 1, efficiencies[-1])
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
                     f'<text x="{x + 6:.1f}" y="{y + 4:.1f}" fill="{colour}">{name}</text>')
    parts.append(f'<text x="{(left + width - right) / 2}" y="{height - 8}" text-anchor="middle">'
                 'ranks that compute</text></svg>')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(parts) + "\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("store", help="store of a finished sweep, whose item times are drawn from")
    parser.add_argument("--svg", help="write the figure")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=20.0, help="of work for each rank")
    arguments = parser.parse_args()
    counts = [2, 8, 32, 128, 512, 1024]
    curves = {}
    print("mean item  batch " + "".join(f"{n:>8}" for n in counts))
    for mean_s in (0.01, 0.1, 1.0):
        for batch_s in (0.25, 1.0, 4.0):
            row = []
            for ranks in counts:
                rng = random.Random(f"{arguments.seed} {mean_s} {ranks}")
                items = max(ranks, int(arguments.seconds * ranks / mean_s))
                times = item_times(arguments.store, mean_s, items, rng)
                row.append(simulate(times, ranks, batch_s, COSTS))
            print(f"{mean_s:7g} s {batch_s:4g} s " + "".join(f"{100 * e:6.1f} %" for e in row))
            if batch_s == 1.0:
                curves[f"{1000 * mean_s:g} ms an item"] = row
    if arguments.svg:
        svg(arguments.svg, counts, curves)


if __name__ == "__main__":
    main()
