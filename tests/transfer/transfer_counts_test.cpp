// Numbers of masks and of visible sets that exceed 32 bits, refused before anything is written.
// SPDX-License-Identifier: MIT
#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "mask_tools.hpp"
#include "methods/transfer/list_begins.hpp"

namespace clgi {
namespace {

TEST(ListBegins, AreSumsOfLengths) {
    EXPECT_EQ(list_begins("it", {3, 0, 5}), (std::vector<std::uint32_t>{0, 3, 3, 8}));
    EXPECT_EQ(list_begins("it", {}), std::vector<std::uint32_t>{0});
    const std::uint32_t most = 0xffffffffu;
    EXPECT_EQ(list_begins("it", {most - 7, 7}).back(), most);
    for (const std::vector<std::uint32_t>& lengths :
         {std::vector<std::uint32_t>{most - 7, 8}, {most, most, most}}) {
        try {
            list_begins("it", lengths);
            ADD_FAILURE() << "lists of more than 2^32 numbers";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("it: the lists have "), std::string::npos);
        }
    }
}

TEST(Counts, OfWorkItemsAndPlanesEndAt32Bits) {
    const std::size_t most = std::size_t{1} << 32;
    EXPECT_NO_THROW(need_items("it", most));
    EXPECT_THROW(need_items("it", most + 1), Error);
    EXPECT_NO_THROW(need_countable("it", "planes", 16, most / 16));
    EXPECT_THROW(need_countable("it", "planes", 16, most / 16 + 1), Error);
    EXPECT_THROW(need_countable("it", "planes", 3, most / 3 + 1), Error);
    EXPECT_NO_THROW(need_countable("it", "planes", 0, most));
    // A product that wraps around 64 bits.
    EXPECT_THROW(need_countable("it", "planes", most, most), Error);
}

// Receivers times packets of columns: 2^25 + 16 of 128 each, in packets of one.
TEST(Counts, OfReceiversThatLookForBlockersAreRefusedBeforeTheirBuffers) {
    MaskOptions masks;
    masks.size = 128;
    masks.block = 4;
    BuildOptions how = test::usual_build();
    how.packet_width = 1;
    ReceiverBuffers receivers;
    receivers.count = receivers.stride = (1u << 25) + 16;
    try {
        test::mask_passes(masks, how)
            .visible(test::device().queue, receivers, {}, test::empty<float>(1),
                     test::empty<cl_uint>(1));
        ADD_FAILURE() << "work-items beyond 2^32";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "transfer.visible: there are 4294969344 work-items, at most 2^32 needed");
    }
}

}  // namespace
}  // namespace clgi
