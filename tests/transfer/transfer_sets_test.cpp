// Visible sets of the dynamic transfer solver: what it refuses, what a failure leaves, and memory.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/kit/picture.hpp>
#include <clgi/dynamic_transfer.hpp>

#include "transfer_scenes.hpp"

namespace clgi {
namespace {

struct Restricted {
    explicit Restricted(std::size_t budget = 0)
        : device(test::on_device(scene())),
          solver(test::programs(), test::device().queue, scene(), device, options(budget)) {
        EXPECT_TRUE(solver.run());
    }
    static const Scene& scene() {
        static const Scene out = [] {
            Scene made = test::heap_of_solids(5);
            test::light_by(made, {1, 1, 1});
            return made;
        }();
        return out;
    }
    static DynamicTransferOptions options(std::size_t budget) {
        DynamicTransferOptions out;
        out.memory_budget = budget;
        return out;
    }
    std::vector<cl_uint> masks() {
        solver.transfer().wait();
        return test::download<cl_uint>(solver.receivers().masks,
                                       32 * std::size_t{solver.receivers().stride});
    }
    std::string refusal(const VisibleSets& sets) {
        try {
            solver.restrict(sets);
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    }
    DeviceScene device;
    DynamicTransferSolver solver;
};

VisibleSets sets_of(Restricted& one) {
    one.solver.look();
    return one.solver.sets();
}

// Lists that do not ascend would be read far behind their end.
TEST(TransferSets, MustBeLists) {
    Restricted one;
    const VisibleSets sets = sets_of(one);
    const auto wanted = one.masks();
    const std::size_t receivers = one.solver.receivers().count;
    ASSERT_EQ(sets.near_lists.size(), receivers + 1);
    VisibleSets wrong = sets;
    wrong.near_lists[7] = static_cast<std::uint32_t>(sets.near.size()) + 100;
    EXPECT_EQ(one.refusal(wrong), "dynamic-transfer: the sets of receiver 7 end before they begin");
    wrong = sets;
    wrong.near_lists[0] = 1;
    EXPECT_NE(one.refusal(wrong).find("begin at 1 and end at"), std::string::npos);
    wrong = sets;
    wrong.near.push_back(0);
    EXPECT_NE(one.refusal(wrong).find("begin at 0 and end at"), std::string::npos);
    wrong = sets;
    wrong.near_lists.pop_back();
    EXPECT_EQ(one.refusal(wrong), "dynamic-transfer: the sets are of " + std::to_string(receivers) +
                                      " receivers less one, " + std::to_string(receivers) +
                                      " needed");
    wrong = sets;
    wrong.near[3] = 1u << 30;
    EXPECT_NE(one.refusal(wrong).find("name triangle 1073741824"), std::string::npos);
    EXPECT_TRUE(one.masks() == wanted);
    EXPECT_EQ(one.refusal(sets), "");
    EXPECT_TRUE(one.masks() == wanted);
}

TEST(TransferSets, AreInTheBudget) {
    Restricted free;
    const std::size_t start = free.solver.bytes();
    const VisibleSets sets = sets_of(free);
    const std::size_t looked = free.solver.bytes();
    EXPECT_GT(looked, start + sets.near_lists.size());
    free.solver.restrict(sets);
    const std::size_t words = sets.near_lists.size() + sets.near.size();
    EXPECT_EQ(free.solver.bytes(), looked + 4 * words + 32);
    free.solver.restrict(sets);  // in place of those of before
    EXPECT_EQ(free.solver.bytes(), looked + 4 * words + 32);

    Restricted none(start);  // all is used up
    EXPECT_THROW(none.solver.look(), DeviceError);
    EXPECT_THROW(none.solver.restrict(sets), DeviceError);
    Restricted little(looked - 1);
    EXPECT_THROW(little.solver.look(), DeviceError);
    Restricted enough(looked + 4 * words + 32);
    EXPECT_NO_THROW(enough.solver.look());
    EXPECT_NO_THROW(enough.solver.restrict(sets));
}

// Sets for which there is no room leave those of before at work.
TEST(TransferSets, ThatDoNotFitChangeNothing) {
    Restricted free;
    const VisibleSets sets = sets_of(free);
    Restricted little(free.solver.bytes() + 100);
    const auto wanted = little.masks();
    little.solver.look();
    const std::size_t before = little.solver.bytes();
    EXPECT_THROW(little.solver.restrict(sets), DeviceError);
    EXPECT_EQ(little.solver.bytes(), before);
    EXPECT_TRUE(little.masks() == wanted);
}

// Buffers of the solver are not beside the scene for those of the picture.
TEST(TransferSets, AreTakenFromThePicture) {
    const test::Device& on = test::device();
    Restricted one;
    PictureOptions options;
    options.width = options.height = 32;
    Picture picture(test::programs(), on.queue, one.device, options, "picture");
    const BufferTable table = picture.table();
    EXPECT_THROW(picture.allocate(table, on.device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>()),
                 DeviceError);
    EXPECT_NO_THROW(picture.allocate(table, one.solver.bytes()));
}

}  // namespace
}  // namespace clgi
