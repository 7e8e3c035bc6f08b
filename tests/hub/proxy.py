# SPDX-License-Identifier: MIT
"""proxy.py LISTEN:TARGET...: forwards TCP on this machine. Stopped with SIGSTOP, it is a line that fails silently."""
import asyncio
import sys


async def pump(reader, writer):
    try:
        while data := await reader.read(65536):
            writer.write(data)
            await writer.drain()
    except OSError:
        pass
    writer.close()


async def join(reader, writer, connecting):
    """Joins a connection and the one that `connecting` opens, in both directions."""
    try:
        there_reader, there_writer = await connecting
    except OSError:
        writer.close()
        return
    await asyncio.gather(pump(reader, there_writer), pump(there_reader, writer))


def forward(target):
    return lambda reader, writer: join(reader, writer, asyncio.open_connection("127.0.0.1", target))


async def main():
    held = [await asyncio.start_server(forward(int(target)), "127.0.0.1", int(listen))
            for listen, target in (pair.split(":") for pair in sys.argv[1:])]
    await asyncio.gather(*(one.serve_forever() for one in held))


if __name__ == "__main__":
    asyncio.run(main())
