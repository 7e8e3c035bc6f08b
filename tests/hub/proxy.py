"""proxy.py LISTEN:TARGET...: forwards TCP on this machine. Stopped (SIGSTOP) it is a line that is dead without a word."""
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


def forward(target):
    async def serve(reader, writer):
        try:
            there_reader, there_writer = await asyncio.open_connection("127.0.0.1", target)
        except OSError:
            writer.close()
            return
        await asyncio.gather(pump(reader, there_writer), pump(there_reader, writer))

    return serve


async def main():
    held = [await asyncio.start_server(forward(int(target)), "127.0.0.1", int(listen))
            for listen, target in (pair.split(":") for pair in sys.argv[1:])]
    await asyncio.gather(*(one.serve_forever() for one in held))


asyncio.run(main())
