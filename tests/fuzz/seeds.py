#!/usr/bin/env python3
"""The inputs that fuzzing begins with: small glTF files of every kind of content, and bytes that
choose scenes and options.

    tests/fuzz/seeds.py FOLDER     writes FOLDER/scene/* and FOLDER/options/*
"""
# SPDX-License-Identifier: MIT
import base64
import json
import pathlib
import random
import struct
import sys
import zlib

FLOAT, USHORT, UBYTE, BYTE = 5126, 5123, 5121, 5120


def png(width, height):
    def chunk(name, data):
        return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))
    rows = b''.join(b'\0' + bytes((16 * x * y + 40) % 256 for x in range(4 * width))
                    for y in range(height))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 6, 0, 0, 0))
            + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


class Draft:
    """One file: a document and the bytes of its only buffer."""

    def __init__(self):
        self.doc = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}],
                    'nodes': [{'mesh': 0}]}
        self.bytes = b''

    def accessor(self, values, kind, component=FLOAT, **more):
        code = {FLOAT: 'f', USHORT: 'H', UBYTE: 'B', BYTE: 'b'}[component]
        width = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}[kind]
        data = struct.pack('<%d%s' % (len(values), code), *values)
        entry = {'bufferView': self.view(data), 'componentType': component, 'type': kind,
                 'count': len(values) // width, **more}
        if kind == 'VEC3' and component == FLOAT:
            entry['min'] = [min(values[k::3]) for k in range(3)]
            entry['max'] = [max(values[k::3]) for k in range(3)]
        if kind == 'SCALAR' and component == FLOAT:
            entry['min'], entry['max'] = [min(values)], [max(values)]
        return self.add('accessors', entry)

    def view(self, data, **more):
        self.bytes += b'\0' * (-len(self.bytes) % 4)
        entry = {'buffer': 0, 'byteOffset': len(self.bytes), 'byteLength': len(data), **more}
        self.bytes += data
        return self.add('bufferViews', entry)

    def add(self, array, entry):
        self.doc.setdefault(array, []).append(entry)
        return len(self.doc[array]) - 1

    def mesh(self, **primitive):
        attributes = {'POSITION': self.accessor([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, .5], 'VEC3')}
        attributes.update(primitive.pop('attributes', {}))
        return self.add('meshes', {'primitives': [{'attributes': attributes, **primitive}]})

    def gltf(self):
        if self.bytes:
            uri = 'data:application/octet-stream;base64,' + base64.b64encode(self.bytes).decode()
            self.doc['buffers'] = [{'byteLength': len(self.bytes), 'uri': uri}]
        return json.dumps(self.doc, separators=(',', ':')).encode()

    def glb(self):
        if self.bytes:
            self.doc['buffers'] = [{'byteLength': len(self.bytes)}]
        text = json.dumps(self.doc, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        data = self.bytes + b'\0' * (-len(self.bytes) % 4)
        chunks = struct.pack('<II', len(text), 0x4E4F534A) + text
        if data:
            chunks += struct.pack('<II', len(data), 0x004E4942) + data
        return struct.pack('<III', 0x46546C67, 2, 12 + len(chunks)) + chunks


def plain():
    draft = Draft()
    draft.mesh(indices=draft.accessor([0, 1, 2, 2, 1, 3], 'SCALAR', USHORT))
    return draft


def modes():
    draft = Draft()
    mesh = draft.mesh(mode=5)
    for mode in (6, 4, 1):
        draft.doc['meshes'][mesh]['primitives'].append(
            dict(draft.doc['meshes'][mesh]['primitives'][0], mode=mode))
    return draft


def sparse():
    draft = plain()
    where = draft.view(struct.pack('<2H', 1, 3))
    what = draft.view(struct.pack('<6f', 2, 0, 0, 2, 2, 0))
    draft.doc['accessors'][1]['sparse'] = {
        'count': 2, 'indices': {'bufferView': where, 'componentType': USHORT},
        'values': {'bufferView': what}}
    return draft


def quantized():
    draft = Draft()
    draft.doc['extensionsUsed'] = draft.doc['extensionsRequired'] = ['KHR_mesh_quantization']
    draft.mesh(attributes={
        'POSITION': draft.accessor([0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0], 'VEC4', BYTE,
                                   normalized=True)})
    draft.doc['accessors'][-1]['type'] = 'VEC3'  # of the plain one: not read
    draft.doc['accessors'][0].update(type='VEC3', min=[0, 0, 0], max=[127, 127, 127], count=3)
    draft.doc['bufferViews'][0]['byteStride'] = 4
    return draft


def lit():
    draft = Draft()
    image = draft.add('images', {'bufferView': draft.view(png(2, 2)), 'mimeType': 'image/png'})
    draft.add('samplers', {'wrapS': 33071, 'magFilter': 9728})
    draft.add('textures', {'source': image, 'sampler': 0})
    draft.add('materials', {
        'pbrMetallicRoughness': {
            'baseColorFactor': [.8, .5, .2, 1], 'metallicFactor': .5, 'roughnessFactor': .4,
            'baseColorTexture': {'index': 0, 'extensions': {
                'KHR_texture_transform': {'scale': [2, 3], 'offset': [.1, 0], 'rotation': .5}}}},
        'emissiveFactor': [1, .5, 0], 'alphaMode': 'MASK', 'alphaCutoff': .3, 'doubleSided': True,
        'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 8}}})
    draft.mesh(material=0, indices=draft.accessor([0, 1, 2], 'SCALAR', USHORT), attributes={
        'NORMAL': draft.accessor([0, 0, 1] * 4, 'VEC3'),
        'TEXCOORD_0': draft.accessor([0, 0, 1, 0, 0, 1, 1, 1], 'VEC2'),
        'COLOR_0': draft.accessor([255, 0, 9, 255] * 4, 'VEC4', UBYTE, normalized=True)})
    draft.doc['extensionsUsed'] = ['KHR_lights_punctual', 'KHR_texture_transform',
                                   'KHR_materials_emissive_strength']
    draft.doc['extensions'] = {'KHR_lights_punctual': {'lights': [
        {'type': 'spot', 'intensity': 10, 'range': 5, 'spot': {'outerConeAngle': .6}},
        {'type': 'point', 'color': [1, .9, .8]}, {'type': 'directional'}]}}
    draft.add('cameras', {'type': 'perspective', 'perspective': {'yfov': .8, 'znear': .01}})
    draft.add('cameras', {'type': 'orthographic', 'orthographic': {
        'xmag': 1, 'ymag': 1, 'znear': 0, 'zfar': 9}})
    for k in range(3):
        draft.add('nodes', {'translation': [k, 2, 1], 'rotation': [0, .6, 0, .8], 'camera': k % 2,
                            'extensions': {'KHR_lights_punctual': {'light': k}}})
    draft.doc['nodes'][0].update(children=[1, 2, 3], scale=[1, -2, .5])
    return draft


def animated():
    draft = Draft()
    joints = draft.accessor([0, 1, 0, 0] * 4, 'VEC4', UBYTE)
    weights = draft.accessor([.25, .75, 0, 0] * 4, 'VEC4')
    target = {'POSITION': draft.accessor([0, 0, .5] * 4, 'VEC3')}
    draft.mesh(indices=draft.accessor([0, 1, 2, 1, 3, 2], 'SCALAR', USHORT), targets=[target],
               attributes={'JOINTS_0': joints, 'WEIGHTS_0': weights})
    draft.doc['meshes'][0]['weights'] = [.5]
    draft.doc['nodes'] = [{'mesh': 0, 'skin': 0, 'children': [1]},
                          {'translation': [0, 1, 0], 'children': [2]}, {'scale': [1, 2, 1]}]
    one = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    draft.add('skins', {'joints': [1, 2],
                        'inverseBindMatrices': draft.accessor(one * 2, 'MAT4')})
    keys = draft.accessor([0, .5, 1], 'SCALAR')
    turn = draft.accessor([0, 0, 0, 1, 0, .6, 0, .8, 0, 0, 0, 1], 'VEC4')
    cubic = draft.accessor([0, 0, 0, 1, 0, 0, 0, 0, 0] * 3, 'VEC3')
    morph = draft.accessor([0, 1, 0], 'SCALAR')
    draft.add('animations', {
        'samplers': [{'input': keys, 'output': turn},
                     {'input': keys, 'output': cubic, 'interpolation': 'CUBICSPLINE'},
                     {'input': keys, 'output': morph, 'interpolation': 'STEP'}],
        'channels': [{'sampler': 0, 'target': {'node': 1, 'path': 'rotation'}},
                     {'sampler': 1, 'target': {'node': 2, 'path': 'translation'}},
                     {'sampler': 2, 'target': {'node': 0, 'path': 'weights'}}]})
    return draft


def main():
    folder = pathlib.Path(sys.argv[1])
    scenes, options = folder / 'scene', folder / 'options'
    for path in (scenes, options):
        path.mkdir(parents=True, exist_ok=True)
    for make in (plain, modes, sparse, quantized, lit, animated):
        (scenes / (make.__name__ + '.gltf')).write_bytes(make().gltf())
        (scenes / (make.__name__ + '.glb')).write_bytes(make().glb())
    cycle = plain()
    cycle.doc['nodes'][0]['children'] = [0]
    (scenes / 'refused_cycle.gltf').write_bytes(cycle.gltf())
    (scenes / 'refused_cut.glb').write_bytes(plain().glb()[:-20])
    chance = random.Random(13)
    for solver in range(4):
        for k in range(6):
            drawn = bytearray(chance.randrange(256) for _ in range(400))
            drawn[0], drawn[1] = solver, k if k < 5 else 13 + solver % 3
            (options / ('%d_%d' % (solver, k))).write_bytes(drawn)


if __name__ == '__main__':
    main()
