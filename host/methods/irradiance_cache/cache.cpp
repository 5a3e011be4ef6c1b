// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/irradiance_cache.hpp>
#include <clgi/passes/cache.hpp>
#include <cmath>
#include <utility>

#include "core/kit/ranges.hpp"
#include "core/opencl/check.hpp"
#include "methods/irradiance_cache/coarse_sky.hpp"
#include "methods/irradiance_cache/records.hpp"
#include "shading/kit/without_sky.hpp"

namespace clgi {
namespace {

constexpr const char* cache_owner = "irradiance-cache";
constexpr std::uint32_t picks_per_record = 16;
constexpr int most_steps = 256, steps_a_look = 8;
constexpr int refinements = 2;
constexpr float rest = 1e-3f;
constexpr float lift_share = 4e-6f;  // of the scene's radius

IrradianceCacheOptions checked(IrradianceCacheOptions options, const DeviceScene& scene) {
    need_range(cache_owner, "seen", options.seen, 1, 20000);
    need_range(cache_owner, "met", options.met, 0, 20000);
    need_range(cache_owner, "refined", options.refined, 0, 20000);
    need_range(cache_owner, "face", options.face, 8, 256);
    need_range(cache_owner, "bounces", options.bounces, 0, 1000);
    if (options.face % 8 != 0)
        throw Error(std::string(cache_owner) + ": face is " + std::to_string(options.face) +
                    ", a multiple of 8 needed");
    if (options.picture.build.storage != Storage::full)
        throw Error(std::string(cache_owner) +
                    ": storage is half, full needed: the host reads where pixels are");
    options.picture = without_sky(options.picture);
    options.picture.shadow_maps = true;  // records are lit by them
    options.picture.build.textures = options.picture.build.textures && scene.needs_textures();
    if (options.emission) options.picture.emitters.area_samples = 0;
    options.picture.emitters.focused = true;
    return options;
}

// A block of pixels has up to four records.
std::size_t most_records(const IrradianceCacheOptions& options) {
    const auto pixels = static_cast<std::size_t>(options.picture.width) *
                        static_cast<std::size_t>(options.picture.height);
    return std::min(4 * static_cast<std::size_t>(options.seen), 4 * pixels) +
           static_cast<std::size_t>(options.met) + static_cast<std::size_t>(options.refined);
}

}  // namespace

Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                  const IrradianceCacheOptions& options) {
    const IrradianceCacheOptions o = checked(options, scene);
    const auto most = static_cast<double>(most_records(o)), face = static_cast<double>(o.face);
    const double records = 1.6 * o.seen + o.met + o.refined;  // as many as a room has
    const double per_record = 5.0 * sizeof(View) + 24.0 * face * face + 12.0 * most +
                              36.0 * (1 + picks_per_record) + 64.0;
    constexpr double pairs = 25.0, drawn = 1e-8;  // a pixel; a triangle in a hemicube, seconds
    const double milliseconds = 1e3 * records *
                                (3.0 * face * face * pairs / pairs_per_second(device) +
                                 drawn * static_cast<double>(scene.info().triangle_count));
    return {static_cast<std::size_t>(most * per_record), milliseconds};
}

struct IrradianceCache::State {
    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& of,
          const IrradianceCacheOptions& wanted)
        : scene(of),
          options(checked(wanted, of)),
          picture(programs, queue, of, options.picture, cache_owner),
          passes(programs, options.picture.build),
          cubes(programs, options.picture.build) {
        capacity = most_records(options);
        stride = plane_stride(capacity);
        sky = coarse_sky(scene.environment());
        BufferTable all = picture.table();
        add_to(all);
        picture.allocate(all);
        passes.build({"link", "bounce", "show"});
        if (options.met > 0) passes.build({"pick"});
        cubes.build({"cubes", "raster_views"});
    }

    void add_to(BufferTable& table) {
        const char* lower = "seen, met, refined or face";
        const std::size_t word = sizeof(float), plane = stride * word;
        const auto face = static_cast<std::size_t>(options.face);
        pick_stride = plane_stride(capacity * picks_per_record);
        table.add(b.planes, "records", lower, RECORD_PLANES * plane);
        table.add(b.views, "hemicubes", lower, 5 * capacity * sizeof(View));
        table.add(b.visibility, "what hemicubes see", lower,
                  3 * face * face * capacity * sizeof(std::uint64_t));
        table.add(b.rows, "transport", lower, 3 * plane * capacity);
        for (cl::Buffer* light : {&b.base, &b.reflected, &b.light, &b.next})
            table.add(*light, "light", lower, 3 * plane);
        table.add(chosen, "records", lower, plane);
        table.add(doubt, "doubt", "width or height", word * picture.stride());
        table.add(places, "places", lower, RECORD_PLANES * pick_stride * word);
        table.add(b.sky, "the sky", "the environment",
                  std::max<std::size_t>(16, sky.texels.size() * word));
    }

    // Reads whole planes, waiting.
    std::vector<CacheRecord> read_records(const cl::Buffer& planes, std::size_t plane_floats,
                                          std::size_t count) {
        std::vector<float> values(RECORD_PLANES * plane_floats);
        const WaitList pending = picture.record().waits();
        picture.record().queue().enqueueReadBuffer(
            planes, CL_TRUE, 0, values.size() * sizeof(float), values.data(), &pending);
        std::vector<CacheRecord> out(count);
        for (std::size_t i = 0; i < count; ++i) {
            glm::vec3* parts[] = {&out[i].position, &out[i].normal, &out[i].geometric};
            for (int part = 0; part < 3; ++part)
                for (int c = 0; c < 3; ++c)
                    (*parts[part])[c] =
                        values[static_cast<std::size_t>(3 * part + c) * plane_floats + i];
        }
        return out;
    }

    void write_records() {
        std::vector<float> values(RECORD_PLANES * std::size_t{stride}, 0.0f);
        std::vector<std::uint32_t> order(stride);
        for (std::size_t i = 0; i < records.size(); ++i) {
            const glm::vec3 parts[] = {records[i].position, records[i].normal,
                                       records[i].geometric};
            for (int part = 0; part < 3; ++part)
                for (int c = 0; c < 3; ++c)
                    values[static_cast<std::size_t>(3 * part + c) * stride + i] = parts[part][c];
            order[i] = static_cast<std::uint32_t>(i);
        }
        picture.record().write(b.planes, values.data(), values.size() * sizeof(float));
        picture.record().write(chosen, order.data(), order.size() * sizeof(std::uint32_t));
    }

    // The scene as records from `first` on see it.
    void draw(std::size_t first) {
        const auto from = static_cast<std::uint32_t>(first);
        const auto count = static_cast<std::uint32_t>(records.size() - first);
        const auto face = static_cast<std::uint32_t>(options.face);
        const float lift = lift_share * scene.frame().detail;
        CubeParams params{};
        params.point_count = count;
        params.faces = 5;
        params.size = face;
        params.first_view = 5 * from;
        params.first_pixel = 3 * face * face * from;
        params.stride = stride;
        params.lift = lift;
        params.near = 0.5f * lift;
        params.first_chosen = from;
        params.turned = 1;
        Recorder& record = picture.record();
        record("gbuffer.cubes", count, [&](const WaitList& wait) {
            return cubes.cubes(record.queue(), params, b.planes, chosen, b.views, wait);
        });
        const ViewSpan span{5 * from, 5 * count, face, face,
                            std::size_t{3} * face * face * records.size()};
        record("gbuffer.raster_views", span.count, [&](const WaitList& wait) {
            return cubes.raster_views(record.queue(), span, b.views, scene, b.visibility,
                                      Pixels::visibility, wait);
        });
    }

    CacheParams params(std::size_t first, std::size_t count) const {
        CacheParams out{};
        out.first = static_cast<std::uint32_t>(first);
        out.count = static_cast<std::uint32_t>(count);
        out.stride = stride;
        out.size = static_cast<std::uint32_t>(options.face);
        out.sky_width = static_cast<std::uint32_t>(sky.width);
        out.sky_height = static_cast<std::uint32_t>(sky.height);
        if (sky.width > 0) {
            const EnvironmentParams turned = environment_params(scene, stride);
            const float exposed = 1.0f / static_cast<float>(scene.frame().exposure);
            for (int c = 0; c < 4; ++c) (&out.sky.x)[c] = (&turned.factor.x)[c] * exposed;
            out.sky_turn = turned.turn;
        }
        out.emission = options.emission ? CACHE_EMISSION_ALL : CACHE_EMISSION_BEYOND;
        out.focus = scene.frame().detail * scene.frame().detail;
        out.picks = picks_per_record;
        out.pick_stride = static_cast<std::uint32_t>(pick_stride);
        out.emitter_count = static_cast<std::uint32_t>(picture.emitters().emitters.size());
        return out;
    }

    // What the records from `first` on see becomes up to `count` more records.
    void meet(std::size_t first, std::size_t count) {
        const std::size_t viewers = records.size() - first;
        if (count == 0 || viewers == 0) return;
        Recorder& record = picture.record();
        record("cache.pick", viewers * picks_per_record, [&](const WaitList& wait) {
            return passes.pick(record.queue(), params(first, viewers), scene, b, places, wait);
        });
        const std::size_t picks = viewers * picks_per_record;
        const std::vector<CacheRecord> seen = read_records(places, pick_stride, picks);
        // One pick of each viewer after the other, so that none of them comes first.
        std::vector<CacheRecord> candidates;
        std::vector<std::size_t> by;
        for (std::size_t k = 0; k < picks_per_record; ++k)
            for (std::size_t v = 0; v < viewers; ++v) {
                candidates.push_back(seen[v * picks_per_record + k]);
                by.push_back(first + v);
            }
        const std::size_t before = records.size();
        add_records(records, candidates, by, count);
        if (records.size() == before) return;
        write_records();
        draw(before);
    }

    void choose(const View& view) {
        Recorder& record = picture.record();
        record.wait();
        shown = read_records(picture.gbuffer().planes, picture.stride(), picture.pixels());
        records = seen_records(shown, static_cast<int>(view.width), static_cast<int>(view.height),
                               options.seen);
        const std::size_t most = capacity - static_cast<std::size_t>(options.met) -
                                 static_cast<std::size_t>(options.refined);
        if (records.size() > most) records.resize(most);
        found.seen = records.size();
        found.met = found.refined = 0;
        if (records.empty()) return;
        write_records();
        draw(0);
        const auto met = static_cast<std::size_t>(options.met);
        meet(0, met - met / 3);
        meet(found.seen, met / 3);
        found.met = records.size() - found.seen;
    }

    // A tree of all records, for one of two uses.
    void plant(CacheTree& planted, cl::Buffer& nodes, cl::Buffer& lists) {
        const RecordTree made = make_tree(records);
        planted = {};
        for (int c = 0; c < 3; ++c) (&planted.centre.x)[c] = made.centre[c];
        planted.centre.w = made.half_side;
        planted.node_count = static_cast<std::uint32_t>(made.nodes.size());
        planted.record_count = static_cast<std::uint32_t>(records.size());
        planted.stride = stride;
        Recorder& record = picture.record();
        grow(nodes, made.nodes.size() * sizeof(std::uint32_t));
        grow(lists, made.lists.size() * sizeof(std::uint32_t));
        record.write(nodes, made.nodes.data(), made.nodes.size() * sizeof(std::uint32_t));
        record.write(lists, made.lists.data(), made.lists.size() * sizeof(std::uint32_t));
    }

    // The transport of the records from `first` on, from those that light goes between.
    void link(std::size_t first) {
        Recorder& record = picture.record();
        if (first == 0) {
            plant(tree, b.nodes, b.lists);
            // To the stride: rows are summed in whole packets.
            for (const cl::Buffer* buffer : {&b.base, &b.reflected, &b.light, &b.next})
                record.fill(*buffer, 0);
            if (!sky.texels.empty())
                record.write(b.sky, sky.texels.data(), sky.texels.size() * sizeof(float));
        }
        const std::size_t count = records.size() - first;
        record("cache.link", count, [&](const WaitList& wait) {
            return passes.link(record.queue(), params(first, count), tree, scene,
                               picture.emitter_buffers(), b, wait);
        });
    }

    // How many nodes a tree has is known when it is made.
    void grow(cl::Buffer& buffer, std::size_t size) {
        const std::size_t held = buffer() ? buffer.getInfo<CL_MEM_SIZE>() : 0;
        if (held < size)
            buffer = cl::Buffer(picture.record().queue().getInfo<CL_QUEUE_CONTEXT>(),
                                CL_MEM_READ_ONLY, size + size / 4);
    }

    void light() {
        Recorder& record = picture.record();
        const auto count = static_cast<std::uint32_t>(records.size());
        record("cache.begin", count, [&](const WaitList& wait) {
            cl::Event copied;
            record.queue().enqueueCopyBuffer(
                b.base, b.light, 0, 0, 3 * std::size_t{stride} * sizeof(float), &wait, &copied);
            return copied;
        });
        const int limit = options.bounces > 0 ? options.bounces : most_steps;
        found.converged = false;
        int step = 0;
        while (step < limit && !found.converged) {
            const int last = std::min(limit, step + steps_a_look);
            for (; step < last; ++step) bounce(0);
            if (options.bounces == 0) found.converged = rests();
        }
        found.bounces = step;
        if (options.bounces > 0) found.converged = true;
    }

    void bounce(std::size_t first) {
        Recorder& record = picture.record();
        const auto count = static_cast<std::uint32_t>(records.size() - first);
        const CacheBounceParams params{count, stride, static_cast<std::uint32_t>(first), 0};
        record("cache.bounce", 3 * count, [&](const WaitList& wait) {
            return passes.bounce(record.queue(), params, b, wait);
        });
        std::swap(b.light, b.next);
    }

    // More records where the light changes between those that are there, in rounds of ever smaller
    // blocks. They gather what the last reflection did for the others, which have no light of
    // theirs.
    void refine(const View& view) {
        if (options.refined == 0) return;
        const auto width = static_cast<int>(view.width), height = static_cast<int>(view.height);
        int side = block_side(width, height, options.seen);
        auto left = static_cast<std::size_t>(options.refined);
        for (int round = 0; round < refinements; ++round) {
            side = std::max(side / 2, 1);
            const std::vector<CacheRecord> more =
                doubtful_records(shown, read_doubt(), width, height, side,
                                 left / static_cast<std::size_t>(refinements - round));
            if (more.empty()) return;
            const std::size_t first = records.size();
            records.insert(records.end(), more.begin(), more.end());
            left -= more.size();
            found.refined += more.size();
            write_records();
            draw(first);
            link(first);
            std::swap(b.light, b.next);
            bounce(first);
            show();
        }
    }

    std::vector<float> read_doubt() {
        std::vector<float> out(picture.pixels());
        const WaitList pending = picture.record().waits();
        picture.record().queue().enqueueReadBuffer(doubt, CL_TRUE, 0, out.size() * sizeof(float),
                                                   out.data(), &pending);
        return out;
    }

    // Whether the last step changed little.
    bool rests() {
        const std::size_t count = 3 * std::size_t{stride};
        std::vector<float> now(count), before(count);
        const cl::CommandQueue& queue = picture.record().queue();
        const WaitList pending = picture.record().waits();
        queue.enqueueReadBuffer(b.light, CL_TRUE, 0, count * sizeof(float), now.data(), &pending);
        queue.enqueueReadBuffer(b.next, CL_TRUE, 0, count * sizeof(float), before.data());
        float most = 0.0f, change = 0.0f;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < records.size(); ++i) {
                const std::size_t at = c * stride + i;
                most = std::max(most, now[at]);
                change = std::max(change, std::abs(now[at] - before[at]));
            }
        return change <= rest * most;
    }

    void show() {
        const bool refined = found.refined > 0;
        if (refined) plant(all_tree, all_nodes, all_lists);
        CacheBuffers all = b;
        if (refined) {
            all.nodes = all_nodes;
            all.lists = all_lists;
        }
        const CacheShowParams params{static_cast<std::uint32_t>(picture.pixels()), picture.stride(),
                                     0, 0};
        picture.record()("cache.show", picture.pixels(), [&](const WaitList& wait) {
            return passes.show(picture.record().queue(), params, refined ? all_tree : tree, all,
                               picture.gbuffer(), picture.irradiance(), doubt, wait);
        });
    }

    const DeviceScene& scene;
    IrradianceCacheOptions options;
    Picture picture;
    CachePasses passes;
    GBufferPasses cubes;
    CacheBuffers b;
    CacheTree tree{}, all_tree{};  // of those that light goes between, of these and refined ones
    CoarseSky sky;
    cl::Buffer all_nodes, all_lists;  // of all_tree
    cl::Buffer chosen, places, doubt;
    std::vector<CacheRecord> records;
    std::vector<CacheRecord> shown;  // what each pixel shows
    std::size_t capacity = 0, pick_stride = 0;
    std::uint32_t stride = 0;
    IrradianceCacheStatus found;
};

IrradianceCache::IrradianceCache(const Programs& programs, const cl::CommandQueue& queue,
                                 const DeviceScene& scene, const IrradianceCacheOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, options)) {}

IrradianceCache::~IrradianceCache() = default;

void IrradianceCache::lights_changed() {
    state_->picture.lights_changed();
    state_->sky = coarse_sky(state_->scene.environment());
}

cl::Event IrradianceCache::render(const Camera& camera, const WaitList& wait) {
    State& s = *state_;
    const View view = s.picture.begin(camera, wait);
    s.choose(view);
    if (s.records.empty()) {
        s.picture.record().fill(s.picture.irradiance(), 0);
    } else {
        s.link(0);
        s.light();
        s.show();
        s.refine(view);
    }
    s.picture.combine(view);
    return s.picture.end(view);
}

IrradianceCacheStatus IrradianceCache::status() const {
    IrradianceCacheStatus out = state_->found;
    out.non_finite = state_->picture.non_finite();
    return out;
}

const Picture& IrradianceCache::picture() const { return state_->picture; }
const IrradianceCacheOptions& IrradianceCache::options() const { return state_->options; }
std::size_t IrradianceCache::bytes() const { return state_->picture.bytes(); }

}  // namespace clgi
